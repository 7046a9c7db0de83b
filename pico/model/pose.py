"""Poses on the table: millimetres and degrees, yaw counter-clockwise seen from above."""

from __future__ import annotations

import math
from dataclasses import dataclass

from pico.model.quantities import Angle, Length


@dataclass(frozen=True, slots=True)
class Pose:
    """A planar pose in the table frame: origin at the front-left corner, x right, y away [mm], yaw [deg]."""

    x: Length
    y: Length
    yaw: Angle = 0.0

    def __str__(self) -> str:
        return f"({short(self.x)}, {short(self.y)}, {short(self.yaw)}°)"

    def apply(self, x: float, y: float) -> tuple[float, float]:
        """Return the local point (x, y) [mm] in the frame that this pose stands in [mm]."""
        c, s = math.cos(math.radians(self.yaw)), math.sin(math.radians(self.yaw))
        return self.x + c * x - s * y, self.y + s * x + c * y

    def compose(self, other: Pose) -> Pose:
        """Return `other`, given in this pose's frame, in the frame that this pose stands in."""
        x, y = self.apply(other.x, other.y)
        return Pose(x, y, wrap(self.yaw + other.yaw))

    def inverse(self) -> Pose:
        """Return the pose that `compose` takes back to the origin."""
        c, s = math.cos(math.radians(self.yaw)), math.sin(math.radians(self.yaw))
        return Pose(-c * self.x - s * self.y, s * self.x - c * self.y, wrap(-self.yaw))

    def distance(self, other: Pose) -> float:
        """Return the distance between the two origins [mm]."""
        return math.hypot(self.x - other.x, self.y - other.y)


Pose.__pydantic_config__ = {"extra": "forbid"}  # type: ignore[attr-defined]


def short(number: float) -> str:
    """Return a length [mm] or an angle [deg] as a person reads it: two decimals at most."""
    return f"{round(number, 2) + 0.0:.10g}"


def wrap(angle: float, period: float = 360.0) -> float:
    """Return `angle` [deg] in (-period/2, period/2]."""
    turned = math.fmod(angle, period)
    if turned <= -period / 2:
        turned += period
    elif turned > period / 2:
        turned -= period
    return turned


def angle_between(a: float, b: float, period: float = 360.0) -> float:
    """Return the shortest signed way from `a` to `b` [deg] where values repeat with `period` [deg]."""
    return wrap(b - a, period)
