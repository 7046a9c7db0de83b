"""Which shutter on the table closes the beam of a laser: the one that the beam meets before anything else."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup
from pico.optics.axis import axis_of

SQUARE = 20.0
"""A shutter further from facing the beam than this does not count [deg]."""


def shutter_of(setup: Setup, seen: Observation, operations: Sequence[Operation], laser: str) -> str | None:
    """Return the component of element `shutter` that stands square in the beam of a laser, or None.

    None where the beam meets another component first, where an operation moves the shutter or the laser, and where one
    moves something to before the shutter: the beam is open there.
    """
    source = seen.components.get(laser)
    if source is None or source.pose is None or source.presence != "seen":
        return None
    standing = {n: c.pose for n, c in seen.components.items() if c.pose is not None and n in setup.lab.inventory}
    first = _first(setup, standing, laser)
    if not first or setup.type_of(first).optics.element != "shutter" or seen.components[first].presence != "seen":
        return None
    goals = list(_goals(operations))
    if {first, laser} & {name for name, _ in goals} or abs(
        angle_between(source.pose.yaw, standing[first].yaw, 180.0)
    ) > SQUARE:
        return None
    gate = {laser: source.pose, first: standing[first]}
    return first if all(_first(setup, {**gate, name: goal}, laser) == first for name, goal in goals) else None


def _first(setup: Setup, poses: Mapping[str, Pose], laser: str) -> str:
    """Return what a beam passes first; empty where that ends it, bends it, or is nothing at all."""
    met = axis_of(setup, poses, laser).meetings[0]
    return met.component if met.event == "passed" else ""


def _goals(operations: Sequence[Operation]) -> Iterator[tuple[str, Pose]]:
    """Yield what operations move, and where to."""
    for operation in operations:
        to = operation.arguments.get("to")
        if isinstance(to, dict) and "pose" in to:
            yield operation.component, Pose(**to["pose"])
