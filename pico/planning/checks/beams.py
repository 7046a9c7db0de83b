"""Which shutter on the table closes the beam of a laser: the one that the beam meets before anything else."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from pico.model.lab import Setup
from pico.model.observation import Observation
from pico.model.operation import Operation
from pico.model.pose import Pose, angle_between

SQUARE = 20.0
"""A shutter further from facing the beam than this does not count [deg]."""
OPENING = "clear_diameter"


def shutter_of(setup: Setup, seen: Observation, operations: Sequence[Operation], laser: str) -> str | None:
    """Return the component of element `shutter` that stands square in the straight beam of a laser, or None.

    None where the beam meets another component first, where an operation moves the shutter or the laser, and where one
    moves something to before the shutter: the beam is open there.
    """
    source = seen.components.get(laser)
    if source is None or source.pose is None or source.presence != "seen":
        return None
    standing = [(n, c.pose) for n, c in sorted(seen.components.items()) if c.pose is not None and n != laser]
    standing += _goals(operations)
    met = [(far, name) for name, pose in standing if (far := _met(setup, source.pose, name, pose)) is not None]
    first = min(met, default=(0.0, ""))[1]
    if not first or setup.type_of(first).optics.element != "shutter":
        return None
    if seen.components[first].presence != "seen" or any(n in (first, laser) for n, _ in _goals(operations)):
        return None
    return first if _square(setup, source.pose, first, seen.components[first].pose) else None


def _goals(operations: Sequence[Operation]) -> Iterator[tuple[str, Pose]]:
    """Yield what operations move, and where to."""
    for operation in operations:
        to = operation.arguments.get("to")
        if isinstance(to, dict) and "pose" in to:
            yield operation.component, Pose(**to["pose"])


def _met(setup: Setup, source: Pose, name: str, pose: Pose) -> float | None:
    """Return how far along the beam a component stands [mm], None where its footprint does not reach the beam."""
    if name not in setup.lab.inventory:
        return None
    along, across = source.inverse().apply(pose.x, pose.y)
    return along if along > 0 and abs(across) < setup.type_of(name).geometry.footprint.radius else None


def _square(setup: Setup, source: Pose, name: str, pose: Pose | None) -> bool:
    """Whether the beam passes through the opening of a shutter, not beside it."""
    opening = setup.type_of(name).optics.properties.get(OPENING)
    if pose is None or not isinstance(opening, int | float):
        return False
    _, across = source.inverse().apply(pose.x, pose.y)
    turned = abs(angle_between(source.yaw, pose.yaw, 180.0))
    return abs(across) < opening / 2 * math.cos(math.radians(turned)) and turned <= SQUARE
