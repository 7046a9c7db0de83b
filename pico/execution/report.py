"""What became of a run, told by its events and by the bench as it was observed afterwards."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, read_diagnostic, warning
from pico.execution.graph import set_back
from pico.model.comparing.drift import drift_of, uncertain
from pico.model.diff import Change, diff_observed, show_value, unread_values, within_trim
from pico.model.measurement import Measurement, measurement_from_json
from pico.model.observation import Aligned, Observation, ObservedComponent
from pico.model.operation import Operation, touched_by
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.state import goals_of, place_of
from pico.model.trace.event import Event
from pico.model.trace.expectation import Expected, GoalRead, goal_read
from pico.model.trace.report import BEYOND_TRIM, GoalEnd, RunReport


def run_report(
    setup: Setup, plan: Plan, events: Sequence[Event], seen: Observation, *, wall: float, able: Capabilities
) -> RunReport:
    """Return the report of a run with these `events`, the last of which ended it, after which `seen` was observed.

    What a plan left within its trim is right where it is, and so is what a goal found that was met.
    """
    asked, goals = plan.asked, tuple(_goals(plan, events))
    right = {f"{c.component}.{c.tunable}": c.aligned for c in plan.changes if c.aligned}
    for goal, op in goals:
        tuned = [f"{component}.{tunable}" for component, tunable in touched_by(op.component, op.arguments)]
        right |= dict.fromkeys(tuned if goal.met else (), Aligned(goal=goal.goal))
    seen = replace(seen, aligned=right)
    whole = not asked and not plan.target.scope
    remaining = _remaining(setup, plan, seen, whole)
    excepted = _excepted(setup, plan, seen) if whole else ()
    return RunReport(
        run=events[-1].run,
        **events[-1].data,
        goal="what was asked" if asked and plan.target.name == "the manifest" else plan.target.name,
        clock="simulated" if able.simulated else "on the bench",
        wall=wall,
        evidence=able.evidence,
        whole=whole,
        held={name: robot.holding for name, robot in sorted(seen.robots.items()) if robot.holding},
        scope=plan.target.scope,
        left=_left(setup, plan, seen) if plan.target.scope else (),
        remaining=remaining,
        excepted=excepted or None,
        unread=(unread_values(seen, plan.target_state) or None) if whole else None,
        absent=_absent(setup, plan, seen) if whole else (),
        expectations=_expectations(setup, plan, seen, able) if whole else (),
        measurements=seen.measurements,
        by_light=_by_light(plan, events) or None,
        goals=tuple(goal for goal, _ in goals) or None,
        aligning=_aligning(plan, events),
        read=tuple(_read(plan, events)) or None,
        off=_off(events),
        put_off=sum(e.kind == "operation_skipped" and bool(e.data.get("one_motion")) for e in events) or None,
        diagnostics=(
            *told_by(events),
            *_left_set(setup, plan, events, seen),
            *_beyond_trim(setup, plan, seen, {goal.goal for goal, _ in goals if goal.met}),
            *_later(plan, events),
        ),
    )


def measured(plan: Plan, events: Sequence[Event]) -> dict[str, Measurement]:
    """Return what was measured in a run of the bench as it then was, by address: what the bench was changed after, but
    for parking and what is set back, counts no more."""
    operations, found = {op.id: op for op in plan.operations}, dict[str, Measurement]()
    for event in events:
        op = operations.get(event.operation or "")
        if op is not None and event.kind == "operation_started":
            if op.kind.mutating and op.reason.kind not in ("interlock", "parked"):
                found.clear()
        elif op is not None and event.kind == "operation_done" and "measurement" in event.data:
            found[op.address] = measurement_from_json(event.data["measurement"])
    return found


def _goals(plan: Plan, events: Sequence[Event]) -> Iterator[tuple[GoalEnd, Operation]]:
    """Yield how each goal of a plan ended that was sought for its alignment, with its operation."""
    sought = {op.id: op for op in plan.operations if op.primitive == "optimize" and op.reason.kind == "align"}
    for event in events:
        op, data = sought.get(event.operation or ""), event.data
        if op is None or event.kind not in ("operation_done", "operation_failed", "operation_unknown"):
            continue
        why = data.get("why") or (data.get("diagnostic") or {}).get("summary", "")
        yield GoalEnd(
            goal=str(op.arguments["goal"]), met=bool(data.get("met")), why=str(why), last=data.get("last"),
            measurements=int(data.get("measurements", 0)), seconds=float(data.get("seconds", 0.0)),
        ), op  # fmt: skip


def _read(plan: Plan, events: Sequence[Event]) -> Iterator[GoalRead]:
    """Yield each goal that was measured where its tunables stand."""
    verified = {op.id: op for op in plan.operations if op.primitive == "verify"}
    for event in events:
        op = verified.get(event.operation or "")
        if op is not None and event.kind in ("operation_done", "operation_failed", "operation_unknown"):
            failed = {"doubt": (event.data.get("diagnostic") or {}).get("summary", "it came to no end")}
            yield goal_read(op.arguments, event.data if event.kind == "operation_done" else failed)


def _off(events: Sequence[Event]) -> Mapping[str, str | float] | None:
    """Return how far at most parts were seen to stand from where they were to be placed; None where none was."""
    placed = [e for e in events if e.kind == "operation_done" and "error_mm" in e.data]
    if not placed:
        return None
    farthest = max(placed, key=lambda e: float(e.data["error_mm"]))
    turned = max(float(e.data.get("error_deg") or 0.0) for e in placed)
    return {"part": farthest.component or "", "mm": float(farthest.data["error_mm"]), "deg": turned}


def _aligning(plan: Plan, events: Sequence[Event]) -> float | None:
    """Return how long the operations took that were there to bring light back [s]; None where there were none."""
    there = {op.id for op in plan.operations if op.aligns}
    ended = [e for e in events if e.operation in there and e.kind in ("operation_done", "operation_failed")]
    return sum(float(e.data.get("seconds", 0.0)) for e in ended) if ended else None


def _remaining(setup: Setup, plan: Plan, seen: Observation, whole: bool) -> tuple[Change, ...]:
    """Return what still differs from the goal beyond tolerance; of one operation, only what it was to change."""
    wanted = plan.target_state
    asked = {(c.component, c.tunable) for c in plan.changes}
    return tuple(
        change
        for change in diff_observed(setup, seen, wanted)
        if (change.counts or (plan.asked and not change.tolerated))
        and (whole or (change.component, change.tunable) in asked)
    )


def _excepted(setup: Setup, plan: Plan, seen: Observation) -> tuple[Change, ...]:
    """Return what differs from the goal and does not count: light that is asked for, and values kept by alignment."""
    wanted = plan.target_state
    return tuple(c for c in diff_observed(setup, seen, wanted) if c.aligned or (c.requested and not c.tolerated))


def _later(plan: Plan, events: Sequence[Event]) -> Iterator[Diagnostic]:
    """Yield what took notably longer than the plan foretold."""
    operations = {op.id: op for op in plan.operations}
    for event in events:
        op, took = operations.get(event.operation or ""), float(event.data.get("seconds") or 0.0)
        if op is None or event.kind != "operation_done" or not op.is_late(took):
            continue
        text = f"{op.primitive} {op.address} took {took:.1f} s, and {op.seconds:.1f} s was foretold"
        hint = "`pico runs show` has each operation beside its forecast; does something drag, or was it tried again?"
        yield Diagnostic("note", "slow", text, hint=hint, address=op.address)


def _beyond_trim(setup: Setup, plan: Plan, seen: Observation, met: Collection[str]) -> Iterator[Diagnostic]:
    """Yield what a goal that was `met` in a run found beyond its trim: its part was probably put down badly."""
    for change in diff_observed(setup, seen, plan.target_state) if met else ():
        kind = setup.type_of(change.component).tunables.get(change.tunable)
        if kind is None or change.aligned is None or change.aligned.goal not in met:
            continue
        if within_trim(kind, change.before, change.after):
            continue
        address = f"{change.component}.{change.tunable}"
        trim = "no trim" if kind.restore.trim is None else f"a trim of {kind.restore.trim:g} {kind.unit}".rstrip()
        text = f"{change.aligned.goal} was met with {address} at {change.before} {kind.unit}"
        yield warning(
            BEYOND_TRIM, f"{text}; around {change.after} it has {trim}", address=address,
            hint=f"`pico capture {address}` writes what light found; or put {change.component} down anew",
        )  # fmt: skip


def _by_light(plan: Plan, events: Sequence[Event]) -> tuple[str, ...]:
    """Return the set-points that light has yet to find: those of which the plan says so, and that no goal met."""
    met = {str(e.data.get("goal")) for e in events if e.kind == "operation_done" and e.data.get("met")}
    said = {d.address for d in plan.diagnostics if d.code == "by-light"}
    if plan.asked:
        return tuple(address for address in sorted(said) if address not in met)
    goals = goals_of(plan.target_state)
    unmet = [of for name, of in goals.items() if name not in met and said & of.keys()]
    return tuple(address for of in unmet for address in of)


def _left(setup: Setup, plan: Plan, seen: Observation) -> tuple[str, ...]:
    """Return what differs from the goal of a plan for some components, and was left alone: components, and single
    tunables (`p1.pose`) of those of which others were asked for."""
    wanted = plan.target_state
    asked = {(c.component, c.tunable) for c in plan.changes}
    parts = {component for component, _ in asked}
    rest = [c for c in drift_of(setup, seen, wanted) if not c.tolerated]
    left = [c for c in rest if (c.component, c.tunable) not in asked]
    return tuple(sorted({f"{c.component}.{c.tunable}" if c.component in parts else c.component for c in left}))


def _absent(setup: Setup, plan: Plan, seen: Observation) -> tuple[str, ...]:
    """Return the components that do not stand where they are seen, or not surely; of those that the goal does not name
    those that lie or are held, for these nobody sees at home."""
    wanted = plan.target_state
    found = []
    for name in sorted(setup.lab.inventory):
        part = seen.components.get(name) or ObservedComponent(presence="missing")
        stands = part.presence == "seen" and not uncertain(setup, name, part, place_of(setup, wanted, name)[0])
        if not stands and (name in wanted.components or part.presence != "missing"):
            found.append(name)
    return tuple(found)


def _expectations(setup: Setup, plan: Plan, seen: Observation, able: Capabilities) -> tuple[Expected, ...]:
    if not plan.target.expect:
        return ()
    from pico.policy.expectations import check_expectations

    return check_expectations(setup, seen, plan.target.expect, able.measurables)


def _left_set(setup: Setup, plan: Plan, events: Sequence[Event], seen: Observation) -> Iterator[Diagnostic]:
    """Yield what was set only to measure, and was not set back."""
    done = {event.operation for event in events if event.kind == "operation_done"}
    left = []
    for back, sets in set_back(plan.operations).items():
        op = next(op for op in plan.operations if op.id == back)
        if back in done or done.isdisjoint(sets):
            continue
        component, tunable = op.component, str(op.arguments["tunable"])
        live, unit = seen.known_values.get(component, {}).get(tunable), setup.type_of(component).tunables[tunable].unit
        now, was = (f"{show_value(value)} {unit}".rstrip() for value in (live, op.arguments["to"]))
        left.append(f"{op.address} at {now} (was {was})")
    if left:
        text, hint = f"left as it was set to measure: {', '.join(left)}", "`pico undo` sets it back"
        yield warning("left-set", text, hint=f"{hint}, with all else that this run set")


def told_by(events: Sequence[Event]) -> Iterator[Diagnostic]:
    """Yield what went wrong with operations."""
    for event in events:
        if event.kind in ("operation_failed", "operation_unknown"):
            yield read_diagnostic(event.data["diagnostic"])
