"""Where the tool is, as the control box tells it: x, y, z [mm], and roll, pitch, yaw [rad] about fixed axes (p03)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pico.motion.kinematics import fk


def tool_pose(joints: Sequence[float], offset: Sequence[float] = (0.0,) * 6) -> tuple[float, ...]:
    """Return the tool's pose in the base frame; `offset` is from the flange to the tool, as register 35 takes it."""
    position, rows = fk(tuple(joints), 0.0)
    flange = np.array(rows) * (-1.0, -1.0, 1.0)  # PICO's gripper is mounted half a turn about the flange's axis
    turned = flange @ rotation(*offset[3:])
    return (*(np.array(position) + flange @ np.array(offset[:3])).tolist(), *angles(turned))


def tool_point(joints: Sequence[float], offset: Sequence[float]) -> tuple[float, ...]:
    """Return where the tool's point alone is [mm]; asked at every step of a motion."""
    position, rows = fk(tuple(joints), 0.0)
    x, y, z = offset[:3]
    return tuple(at - row[0] * x - row[1] * y + row[2] * z for at, row in zip(position, rows, strict=True))


def rotation(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """Return Rz(yaw) Ry(pitch) Rx(roll), (3, 3)."""
    (a, b), (c, d), (e, f) = ((math.cos(v), math.sin(v)) for v in (roll, pitch, yaw))
    return np.array(
        [
            [e * c, e * d * b - f * a, e * d * a + f * b],
            [f * c, f * d * b + e * a, f * d * a - e * b],
            [-d, c * b, c * a],
        ]
    )


def angles(turned: np.ndarray) -> tuple[float, float, float]:
    """Return roll, pitch and yaw [rad] of a rotation (3, 3)."""
    level = math.hypot(turned[0, 0], turned[1, 0])
    pitch = math.atan2(-turned[2, 0], level)
    if level < 1e-9:
        return math.atan2(-turned[1, 2], turned[1, 1]), pitch, 0.0
    return math.atan2(turned[2, 1], turned[2, 2]), pitch, math.atan2(turned[1, 0], turned[0, 0])
