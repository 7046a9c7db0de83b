"""What is done on a bench and when, of a plan that has not run and of a run that is over: what a replay is made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pico.model.observation import (
    Observation,
    ObservedComponent,
    ObservedRobot,
    ObservedValue,
    observed_from_json,
    with_value,
)
from pico.model.operation import Operation, Reason, searched_by
from pico.model.plan import Plan
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.runs.document import RecordedRun
from pico.runs.operations import OperationRun, operations

REST = 1.0
"""Seconds between two runs that are folded into one, whose clocks nobody compared."""


@dataclass(frozen=True, slots=True)
class Deed:
    """One operation: when it began, and how long it took [s]; `after`: how its component was then, None where nobody
    looked. `planned`: the seconds that its plan reckoned with."""

    operation: Operation
    start: float
    seconds: float
    outcome: str = "done"
    after: ObservedComponent | None = None
    attempt: int = 1
    run: str = ""
    planned: float | None = None

    @property
    def end(self) -> float:
        """When it was over [s]."""
        return self.start + self.seconds


def deeds_of_plan(plan: Plan) -> tuple[Deed, ...]:
    """Return what a plan has done, when it reckons with it."""
    return tuple(Deed(op, op.start, op.seconds, planned=op.seconds) for op in plan.operations)


def deeds_of_run(run: RecordedRun) -> tuple[Deed, ...]:
    """Return what began in a run, in the order in which it began; runs that are folded into it one after another."""
    ends = {(e.run or "", e.operation, e.attempt): e.data for e in run.trace if e.kind in ("done", "failed", "unknown")}
    meant = {(e.run or "", e.operation, e.attempt): e.data for e in run.trace if e.kind == "intent"}
    found: list[Deed] = []
    began, current = 0.0, None
    for one in operations(run.trace):
        if one.start is None:
            continue
        if one.run != current:
            began, current = max((d.end for d in found), default=-REST) + REST, one.run
        key = one.run, one.id, one.attempt
        after = _seen(ends.get(key, {}).get("after"))
        found.append(
            Deed(
                _operation(one, meant.get(key, {})), began + one.start, one.seconds or 0.0, one.outcome, after,
                one.attempt, one.run, one.planned,
            )
        )  # fmt: skip
    return tuple(sorted(found, key=lambda deed: deed.start))


def _operation(one: OperationRun, meant: Mapping[str, Any]) -> Operation:
    robot = meant.get("robot")
    return Operation(
        id=one.id, primitive=one.primitive, component=one.component, arguments=one.arguments,
        robot=robot if isinstance(robot, str) else None, reason=Reason(kind="asked"),
    )  # fmt: skip


def before(setup: Setup, run: RecordedRun, deeds: Sequence[Deed]) -> Observation:
    """Return the bench as a run found it, as far as it was kept: what was observed afterwards, less what the run did;
    arms are parked, for no run keeps their joints."""
    parts = {name: part for name, part in _kept(setup, run).items() if name in setup.lab.inventory}
    for event in reversed(run.trace):  # what an operation saw before it began, the first one last
        name = event.component or ""
        if event.kind == "started" and name in setup.lab.inventory:
            seen = _seen(event.data.get("before"))
            if seen is not None:
                parts[name] = seen
    robots = {name: ObservedRobot(joints=robot.park_joints) for name, robot in setup.lab.robots.items()}
    found = Observation(backend="", components=parts, robots=robots)
    for deed in reversed(deeds):
        begun = deed.operation.arguments.get("from")
        if searched_by(deed.operation.arguments) and isinstance(begun, Mapping):
            found = with_values(found, begun)
    return found


def _kept(setup: Setup, run: RecordedRun) -> dict[str, ObservedComponent]:
    """Return what is known of the parts on the bench of a run: as it was before, else as it was seen afterwards."""
    if run.before is not None:
        return {name: _stood(setup, run.before, name) for name in run.before.components if name in setup.lab.inventory}
    seen = {e.component: _seen(e.data) for e in run.measurements if e.kind == "observation" and e.component}
    return {name: part for name, part in seen.items() if part is not None}


def _stood(setup: Setup, state: LabState, name: str) -> ObservedComponent:
    values = {tunable: ObservedValue(value=value) for tunable, value in state.components[name].values.items()}
    return ObservedComponent(pose=place_of(setup, state, name)[1], values=values)


def with_values(seen: Observation, values: Mapping[str, Any]) -> Observation:
    """Return what would be seen with tunables at values, by address; what is no value of a part that is seen is passed
    over."""
    for address, value in values.items():
        component, _, tunable = address.partition(".")
        if tunable and tunable != "pose" and component in seen.components and isinstance(value, int | float | str):
            seen = with_value(seen, component, tunable, value)
    return seen


def led_to(deed: Deed, seen: Observation) -> ObservedComponent | None:
    """Return how the component of a deed is when it is over: as it was seen, else as the operation says; None where
    that says nothing."""
    op, part = deed.operation, seen.components.get(deed.operation.component)
    if deed.after is not None or part is None or deed.outcome != "done":
        return deed.after
    to = op.arguments.get("to")
    if isinstance(to, Mapping) and "pose" in to:
        return replace(part, presence="seen", pose=Pose(**to["pose"]), how="")
    tunable = op.arguments.get("tunable")
    if op.primitive == "set" and isinstance(tunable, str) and isinstance(to, int | float | str):
        return with_value(seen, op.component, tunable, to).components[op.component]
    return None


def _seen(data: Any) -> ObservedComponent | None:
    """Read a component as an operation saw it; None for what another program wrote."""
    try:
        return observed_from_json(data)
    except (KeyError, TypeError, ValueError):
        return None
