"""The postures of an arm that hold its tool at a point."""

from __future__ import annotations

from pico.model.robot import Robot
from pico.motion.kinematics import columns
from pico.motion.types import Joints


def ik(robot: Robot, x: float, y: float, z: float, yaw: float) -> tuple[Joints, ...]:
    """Return every joint vector within limits that holds the tool vertical at (x, y, z) [mm, table frame].

    `yaw` [deg, table frame] is the direction in which the jaws close; the part in hand turns with it, so `yaw` and
    `yaw` + 180 are different answers here. Joints 3 and 5 are zero; see `columns` for the rest and the order. Empty
    where the point is out of reach.
    """
    return tuple(joints for column in columns(robot, x, y, yaw) if (joints := column.at(z)) is not None)
