"""A run that somebody watches: its events one by one, and in the end a report of the bench as it then is."""

from __future__ import annotations

import secrets
import time
from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from dataclasses import replace
from datetime import UTC, datetime

from pico.backends.protocol import Backend
from pico.diagnostics import Diagnostic, PicoError
from pico.execution.about import seen_after
from pico.execution.run import run
from pico.model.diff import Change, diff_observed
from pico.model.drift import drift_of, uncertain
from pico.model.event import Event
from pico.model.expectation import Expected
from pico.model.lab import Setup
from pico.model.measurement import Measurement, measurement_from_json
from pico.model.observation import Observation, ObservedComponent
from pico.model.plan import Plan
from pico.model.report import RunReport
from pico.model.state import place_of, state_from_json
from pico.runs.journal import Journal


class AsyncExecution:
    """A plan under way: iterate over it for its events, then read its `report`."""

    def __init__(
        self,
        setup: Setup,
        plan: Plan,
        backend: Backend,
        named: Callable[[], str] | None = None,
        holder: str = "pico apply",
        *,
        resumes: str | None = None,
        stop_on_error: bool = False,
    ) -> None:
        """`named`: what the goal is called once the run is over. `resumes`: the run that goes on under its id.
        `stop_on_error`: the first failure lets nothing more start.
        """
        self.plan, self.id = plan, resumes or new_run_id()
        self._resumed, self._stop_on_error = resumes is not None, stop_on_error
        self._setup, self._backend, self._holder = setup, backend, holder
        self._named = named or (lambda: plan.target.name)
        self._report: RunReport | None = None
        self._cancelled = False

    @property
    def report(self) -> RunReport:
        """What became of the run; raises RuntimeError before it is over."""
        if self._report is None:
            raise RuntimeError("the run is not over: iterate over it to the end")
        return self._report

    async def halt(self) -> None:
        """Start nothing more, and bring every robot to a safe waypoint; the events then come to their end."""
        self._cancelled = True
        await self._backend.halt()

    async def stop(self) -> None:
        """Stop all motion now; the events then come to their end."""
        self._cancelled = True
        await self._backend.stop()

    async def __aiter__(self) -> AsyncIterator[Event]:
        """Yield the events; raises PicoError, before anything moves, where the plan must not be run (see `run`)."""
        started = time.monotonic()
        events: list[Event] = []
        async for event in run(
            self.plan, self._backend, run_id=self.id, holder=self._holder, setup=self._setup,
            cancelled=lambda: self._cancelled, stop_on_error=self._stop_on_error, resumed=self._resumed,
        ):  # fmt: skip
            if event.kind != "operation_progress":
                events.append(event)
            yield event
        evidence = (await self._backend.describe()).evidence
        wall = time.monotonic() - started
        seen = replace(await self._backend.observe(), measurements=measured(self.plan, events))
        report = run_report(self._setup, self.plan, events, seen, wall=wall, evidence=evidence)
        goal = self._named() if report.goal == self.plan.target.name else report.goal
        self._report = replace(report, goal=goal, diagnostics=(*report.diagnostics, *self._keep(report, seen)))

    def _keep(self, report: RunReport, seen: Observation) -> Sequence[Diagnostic]:
        """Journal how the bench was seen afterwards; what keeps that from being written must not hide the report."""
        journal: Journal | None = getattr(self._backend, "journal", None)
        reached = report.whole and report.outcome == "done" and report.reached
        try:
            if journal is not None:
                journal.saw(self.id, seen_after(seen, report.expectations, reached=reached))
        except PicoError as exc:
            return exc.diagnostics
        return ()


def new_run_id() -> str:
    """Return the id of a run: the time in UTC, and six random characters."""
    return f"{datetime.now(UTC):%Y%m%dT%H%M%SZ}-{secrets.token_hex(3)}"


def run_report(
    setup: Setup, plan: Plan, events: Sequence[Event], seen: Observation, *, wall: float, evidence: str
) -> RunReport:
    """Return the report of a run with these `events`, the last of which ended it, after which `seen` was observed."""
    asked = plan.asked
    whole = not asked and not plan.target.scope
    return RunReport(
        run=events[-1].run,
        **events[-1].data,
        goal="what was asked" if asked and plan.target.name == "the manifest" else plan.target.name,
        clock="simulated" if plan.backend == "sim" else "on the bench",
        wall=wall,
        evidence=evidence,
        whole=whole,
        held={name: robot.holding for name, robot in sorted(seen.robots.items()) if robot.holding},
        scope=plan.target.scope,
        left=_left(setup, plan, seen) if plan.target.scope else (),
        remaining=_remaining(setup, plan, seen, whole),
        absent=_absent(setup, plan, seen) if whole else (),
        expectations=_expectations(setup, plan, seen) if whole else (),
        measurements=seen.measurements,
        diagnostics=tuple(_diagnostics(events)),
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


def _remaining(setup: Setup, plan: Plan, seen: Observation, whole: bool) -> tuple[Change, ...]:
    """Return what still differs from the goal beyond tolerance; of one operation, only what it was to change."""
    wanted = state_from_json(plan.lab.name, plan.target.state)
    asked = {(c.component, c.tunable) for c in plan.changes}
    return tuple(
        change
        for change in diff_observed(setup, seen, wanted)
        if not change.tolerated and (whole or (change.component, change.tunable) in asked)
    )


def _left(setup: Setup, plan: Plan, seen: Observation) -> tuple[str, ...]:
    """Return what differs from the goal of a plan for some components, and was left alone: components, and single
    tunables (`p1.pose`) of those of which others were asked for."""
    wanted = state_from_json(plan.lab.name, plan.target.state)
    asked = {(c.component, c.tunable) for c in plan.changes}
    parts = {component for component, _ in asked}
    rest = [c for c in drift_of(setup, seen, wanted) if not c.tolerated]
    left = [c for c in rest if (c.component, c.tunable) not in asked]
    return tuple(sorted({f"{c.component}.{c.tunable}" if c.component in parts else c.component for c in left}))


def _absent(setup: Setup, plan: Plan, seen: Observation) -> tuple[str, ...]:
    """Return the components that do not stand where they are seen, or not surely; of those that the goal does not name
    those that lie or are held, for these nobody sees at home."""
    wanted = state_from_json(plan.lab.name, plan.target.state)
    found = []
    for name in sorted(setup.lab.inventory):
        part = seen.components.get(name) or ObservedComponent(presence="missing")
        stands = part.presence == "seen" and not uncertain(setup, name, part, place_of(setup, wanted, name)[0])
        if not stands and (name in wanted.components or part.presence != "missing"):
            found.append(name)
    return tuple(found)


def _expectations(setup: Setup, plan: Plan, seen: Observation) -> tuple[Expected, ...]:
    if not plan.target.expect:
        return ()
    from pico.policy.expectations import check_expectations

    return check_expectations(setup, seen, plan.target.expect)


def _diagnostics(events: Sequence[Event]) -> Iterator[Diagnostic]:
    for event in events:
        if event.kind in ("operation_failed", "operation_unknown"):
            yield Diagnostic(**{**event.data["diagnostic"], "source": None})
