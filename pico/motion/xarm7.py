"""The UFACTORY xArm7 as numbers: where its joints sit and how far and fast they turn.

Joint origins and ranges: the vendor's published URDF. Greatest speed: the vendor's manual (180 deg/s; of the
tool 1 m/s, see `pico.model.robot.Robot`).
Greatest acceleration: the vendor's SDK (20 rad/s2). The jerk is not published: 500 rad/s3 is an assumption.
"""

from __future__ import annotations

import math

from pico.model.robot import XARM7_RANGES

ORIGINS: tuple[tuple[float, float, float], ...] = (
    (0.0, 0.0, 267.0),
    (0.0, 0.0, 0.0),
    (0.0, -293.0, 0.0),
    (52.5, 0.0, 0.0),
    (77.5, -342.5, 0.0),
    (0.0, 0.0, 0.0),
    (76.0, 97.0, 0.0),
)
"""Origin of each joint in the frame of the link before it [mm]."""

ROLLS: tuple[int, ...] = (0, -90, 90, 90, 90, 90, -90)
"""How each joint's frame is turned about the x axis of the link before it [deg]; the joint turns about its z."""

LIMITS: tuple[tuple[float, float], ...] = tuple((math.radians(low), math.radians(high)) for low, high in XARM7_RANGES)
"""Range of each joint [rad]."""

JOINT_SPEED = math.pi
"""Greatest speed of a joint [rad/s]."""
JOINT_ACCELERATION = 20.0
"""Greatest acceleration of a joint [rad/s2]."""
JOINT_JERK = 500.0
"""Greatest jerk of a joint [rad/s3]; an assumption."""
