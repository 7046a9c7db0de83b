"""Where every link of an arm is, for many postures at once: the forward kinematics of the second collision check.

In metres. Links are counted 0 (base) to 7 (flange), then the gripper (8) and the part in hand (9); all of them in the
plane of joint 1, that is as seen from link 1, where the base is what turns. `world` turns them all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from pico.model.robot import Mount
from pico.motion.types import Joints, Segment
from pico.motion.xarm7 import ORIGINS, ROLLS

Array = Any
"""A numpy array of floats."""

GRIPPER, HELD = 8, 9
_HALF_TURN = np.diag((-1.0, -1.0, 1.0))


def densely(segment: Segment, step: float) -> Array:
    """Return the waypoints of a segment and postures between them, no joint farther than `step` [rad] from one to the
    next: an array (N, 7)."""
    way = np.array(segment.joints)
    counts = np.maximum(1, np.ceil(np.abs(np.diff(way, axis=0)).max(axis=1) / step - 1e-9).astype(int))
    index = np.repeat(np.arange(len(counts)), counts)
    share = np.concatenate([np.arange(n) / n for n in counts])[:, None]
    return np.vstack((way[index] * (1 - share) + way[index + 1] * share, way[-1:]))


def in_plane(joints: Array, hold: tuple[float, float]) -> tuple[Array, Array]:
    """Return rotations (N, 10, 3, 3) and origins (N, 10, 3) of all links.

    `hold`: depth of the origin of the part in hand below the flange [m], and grasp yaw [deg].
    """
    n = len(joints)
    turns, origins = np.empty((n, 10, 3, 3)), np.empty((n, 10, 3))
    turn, origin = np.broadcast_to(np.eye(3), (n, 3, 3)), np.zeros((n, 3))
    turns[:, 0], origins[:, 0] = about_z(-joints[:, 0]), origin
    for i, (offset, roll) in enumerate(zip(ORIGINS, ROLLS, strict=True)):
        origin = origin + turn @ (np.array(offset) / 1000)
        angles = joints[:, i] if i else np.zeros(n)
        turn = turn @ _about_x(math.radians(roll)) @ about_z(angles)
        turns[:, i + 1], origins[:, i + 1] = turn, origin
    turns[:, GRIPPER], origins[:, GRIPPER] = turn @ _HALF_TURN, origin
    depth, yaw = hold
    turns[:, HELD] = turns[:, GRIPPER] @ _hand_to_part(math.radians(yaw))
    origins[:, HELD] = origin + depth * turn[:, :, 2]
    return turns, origins


def world(mount: Mount, first: Array) -> tuple[Array, Array]:
    """Return rotations (N, 3, 3) by joint 1 at `first` [rad] and by the mount, and where the base is on the table."""
    return about_z(first + math.radians(mount.yaw)), np.array((mount.x, mount.y, mount.z)) / 1000


def one(joints: Joints) -> Array:
    """Return the array of a single posture."""
    return np.array([joints])


def about_z(angles: float | Sequence[float] | Array) -> Array:
    """Return rotation matrices (..., 3, 3) about z by `angles` [rad]."""
    c, s = np.cos(angles), np.sin(angles)
    zero, unit = np.zeros_like(c), np.ones_like(c)
    return np.stack((c, -s, zero, s, c, zero, zero, zero, unit), axis=-1).reshape((*np.shape(c), 3, 3))


def _about_x(angle: float) -> Array:
    c, s = round(math.cos(angle), 15), round(math.sin(angle), 15)
    return np.array(((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c)))


def _hand_to_part(grasp: float) -> Array:
    """The part's axes in the gripper's frame: its z against the tool, the jaws (y) at `grasp` [rad] from its x."""
    c, s = math.cos(grasp), math.sin(grasp)
    return np.array(((-s, c, 0.0), (c, s, 0.0), (0.0, 0.0, -1.0)))
