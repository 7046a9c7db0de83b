"""What a person steers, and how far one step of it goes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from pico.model.catalog import Tunable
from pico.model.pose import Pose
from pico.model.record import record
from pico.model.setup import Setup
from pico.teleop.frames import STEP_SECONDS

SLOW = 250.0
"""Greatest speed of the tool while a person steers it [mm/s]."""
IN_PLANE: Mapping[str, tuple[str, float]] = {"x": ("mm", 1.0), "y": ("mm", 1.0), "yaw": ("deg", 0.2)}
"""Of a part that an arm holds: what is jogged, with its unit and the longest step, which an arm makes at rest to rest
within STEP_SECONDS."""
_FREE = 10.0
"""Longest step of what has neither axis nor range."""


@record
class Jogged:
    """One thing that is jogged: its unit, its range (None: it has none), its period, and the longest step."""

    unit: str
    longest: float
    range: tuple[float, float] | None = None
    period: float | None = None

    def after(self, here: float, by: float) -> float:
        """Return where a step leads, within the range."""
        there = here + by
        if self.range is not None:
            return min(max(there, min(self.range[0], here)), max(self.range[1], here))
        return there % self.period if self.period else there


def jogged(setup: Setup, component: str, tunables: Mapping[str, Any]) -> dict[str, Jogged]:
    """Return what is jogged in a teleoperation of `tunables`, by address; x, y and yaw of a pose."""
    if f"{component}.pose" in tunables:
        return {name: Jogged(unit=unit, longest=longest) for name, (unit, longest) in IN_PLANE.items()}
    names = [address.partition(".")[2] for address in tunables]
    return {name: of(setup.type_of(component).tunables[name]) for name in names}


def of(kind: Tunable) -> Jogged:
    """Return how a tunable is jogged: as far as its axis goes in STEP_SECONDS; what electronics set, a tenth of its
    range."""
    if kind.axis is not None and kind.axis.speed > 0:
        longest = kind.axis.speed * STEP_SECONDS
    else:
        longest = (kind.range[1] - kind.range[0]) / 10 if kind.range else _FREE
    return Jogged(unit=kind.unit, longest=longest, range=kind.range, period=kind.period)


def ladder(longest: float, resolution: float = 0.0) -> list[float]:
    """Return the steps that a person chooses from, 1, 2, 5 and so on, up to `longest`; at least one."""
    top = math.floor(math.log10(longest)) if longest > 0 else 0
    steps = [float(f"{m}e{e}") for e in range(top - 4, top + 1) for m in (1, 2, 5)]
    return [s for s in steps if max(resolution, 0.0) <= s <= longest * (1 + 1e-9)] or [longest]


def moved(pose: Pose, name: str, by: float) -> Pose:
    """Return a pose after a step along x or y [mm], or in yaw [deg]."""
    step = {"x": 0.0, "y": 0.0, "yaw": 0.0, name: by}
    return Pose(pose.x + step["x"], pose.y + step["y"], pose.yaw + step["yaw"])


def numbers(values: Mapping[str, object]) -> Iterator[tuple[str, float]]:
    """Yield what of some values is a number."""
    for name, value in values.items():
        if isinstance(value, int | float) and not isinstance(value, bool):
            yield name, float(value)
