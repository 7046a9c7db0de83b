"""Where a body stands in space, between poses on the table and MuJoCo's positions and quaternions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.model.pose import Pose, wrap

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Placement:
    """A pose in space: position of the base frame [m] and unit quaternion (w, x, y, z), in the table frame."""

    position: Vector
    quaternion: Quaternion = (1.0, 0.0, 0.0, 0.0)

    @property
    def tilt(self) -> float:
        """The angle between the body's own z and the vertical [deg]."""
        _, x, y, _ = self.quaternion
        return math.degrees(math.acos(max(-1.0, min(1.0, 1.0 - 2.0 * (x * x + y * y)))))

    @property
    def pose(self) -> Pose:
        """The pose of the origin seen from above [mm, deg]; yaw is where the body's x points."""
        w, x, y, z = self.quaternion
        yaw = math.degrees(math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))
        return Pose(self.position[0] * 1000, self.position[1] * 1000, wrap(yaw))


def upright(pose: Pose, z: float = 0.0) -> Placement:
    """Return the placement of a body that stands at `pose` with its base `z` [mm] above the table."""
    half = math.radians(pose.yaw) / 2
    return Placement((pose.x / 1000, pose.y / 1000, z / 1000), (math.cos(half), 0.0, 0.0, math.sin(half)))


def placement_of(position: Sequence[float], quaternion: Sequence[float]) -> Placement:
    """Return the placement with MuJoCo's `position` [m] and `quaternion`, as plain floats."""
    x, y, z = (float(v) for v in position)
    a, b, c, d = (float(v) for v in quaternion)
    return Placement((x, y, z), (a, b, c, d))
