"""The bench as it will be seen once operations are done: parts where they are put, tunables at what they are set to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from pico.model.observation import Observation, ObservedComponent, ObservedValue
from pico.model.operation import Operation
from pico.model.pose import Pose
from pico.model.setup import Setup


def foreseen(setup: Setup, seen: Observation, operations: Sequence[Operation]) -> Observation:
    """Return the observation after operations, in their order; what an optimization finds nobody foresees."""
    parts = dict(seen.components)
    for op in operations:
        part, to = parts.get(op.component), _homed(setup, op) if op.primitive == "home" else op.arguments.get("to")
        if part is None or to is None:
            continue
        parts[op.component] = _after(part, to, op.arguments.get("tunable"))
    return replace(seen, components=parts)


def _homed(setup: Setup, op: Operation) -> float | None:
    axis = setup.type_of(op.component).tunables[str(op.arguments["tunable"])].axis
    return axis.home if axis else None


def _after(part: ObservedComponent, to: object, tunable: object) -> ObservedComponent:
    if isinstance(to, Mapping):
        return replace(part, presence="seen", pose=Pose(**to["pose"])) if "pose" in to else part
    if not isinstance(tunable, str) or not isinstance(to, bool | int | float | str):
        return part
    return replace(part, values={**part.values, tunable: ObservedValue(value=to)})
