"""Joints for a pose of the tool, and along a straight line of the tool, as the control box finds them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pico.emulators.xarm.kinematics import angles, rotation, tool_pose
from pico.emulators.xarm.motions import Planned
from pico.motion.types import Joints
from pico.motion.xarm7 import LIMITS

_STEP = 1e-6
_ROUNDS = 60
_CLOSE = 1e-3
"""How far [mm, and mrad] from the pose joints may leave the tool."""
_LEVER = 200.0
"""How many mm of way a turn of one radian counts."""
_PIECE = 2.0
"""How far apart joints are computed along a line [mm]."""

Pose6 = Sequence[float]
"""x, y, z [mm], roll, pitch, yaw [rad] about fixed axes."""


def inverse(pose: Pose6, near: Joints, offset: Pose6) -> Joints | None:
    """Return joints [rad] within their ranges that bring the tool to `pose`, found from `near` by damped least squares;
    None if there are none near by."""
    low, high = np.array(LIMITS).T
    goal, joints = rotation(*pose[3:]), np.array(near)
    for _ in range(_ROUNDS):
        off = _error(pose, goal, joints, offset)
        if np.abs(off).max() < _CLOSE:
            return tuple(joints.tolist())
        jacobian = np.empty((6, 7))
        for joint in range(7):
            nudged = joints.copy()
            nudged[joint] += _STEP
            jacobian[:, joint] = (off - _error(pose, goal, nudged, offset)) / _STEP
        damped = jacobian @ jacobian.T + 1e-3 * np.eye(6) * (1.0 + float(np.abs(off).max()))
        step = jacobian.T @ np.linalg.solve(damped, off)
        joints = np.clip(joints + step * min(1.0, 0.3 / max(1e-9, float(np.abs(step).max()))), low, high)
    return None


def _error(pose: Pose6, goal: np.ndarray, joints: np.ndarray, offset: Pose6) -> np.ndarray:
    """What is left to the pose: mm, and 1000 times rad."""
    now = tool_pose(joints.tolist(), offset)
    turn = turned(goal @ rotation(*now[3:]).T)
    return np.concatenate((np.array(pose[:3]) - np.array(now[:3]), 1000 * turn))


def turned(matrix: np.ndarray) -> np.ndarray:
    """Return a rotation as its axis times its angle [rad], up to half a turn."""
    axis = np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])
    sine, cosine = float(np.linalg.norm(axis)) / 2, (float(np.trace(matrix)) - 1) / 2
    if cosine < -0.99:  # close to half a turn the difference above is lost in rounding
        square = (matrix + matrix.T) / 2 - cosine * np.eye(3)
        column = square[:, int(np.argmax(np.diag(square)))]
        column = column / np.linalg.norm(column) * (-1.0 if float(column @ axis) < 0 else 1.0)
        around: np.ndarray = column * math.atan2(sine, cosine)
        return around
    found: np.ndarray = axis * (math.atan2(sine, cosine) / (2 * sine) if sine > 1e-9 else 0.5)
    return found


def composed(first: Pose6, second: Pose6) -> tuple[float, ...]:
    """Return the pose that `second`, as it stands in the frame `first`, has outside of that."""
    turn = rotation(*first[3:])
    return (*(np.array(first[:3]) + turn @ np.array(second[:3])).tolist(), *angles(turn @ rotation(*second[3:])))


@dataclass(frozen=True)
class Line:
    """A straight way of the tool through `joints`, equally far apart; `ride` is the distance gone [mm]."""

    joints: tuple[Joints, ...]
    ride: Planned

    @property
    def end(self) -> Joints:
        return self.joints[-1]

    def at(self, now: float) -> Joints:
        (gone,), (whole,) = self.ride.at(now), self.ride.end
        place = (gone / whole if whole else 1.0) * (len(self.joints) - 1)
        index = min(int(place), len(self.joints) - 2)
        a, b, share = self.joints[index], self.joints[index + 1], place - index
        return tuple(p + share * (q - p) for p, q in zip(a, b, strict=True))

    def over(self, now: float) -> bool:
        return self.ride.over(now)


def line(start: Joints, pose: Pose6, offset: Pose6, speed: float, acceleration: float, now: float) -> Line | None:
    """Return the straight way of the tool from `start` to `pose` at `speed` [mm/s]; None if the joints can't follow."""
    here = tool_pose(start, offset)
    turn = turned(rotation(*pose[3:]) @ rotation(*here[3:]).T)
    angle = float(np.linalg.norm(turn))
    length = max(math.dist(here[:3], pose[:3]), _LEVER * angle)
    count = max(1, math.ceil(length / _PIECE))
    axis = turn / angle if angle > 1e-9 else np.array([0.0, 0.0, 1.0])
    found = [start]
    for number in range(1, count + 1):
        share = number / count
        point = [a + share * (b - a) for a, b in zip(here[:3], pose[:3], strict=True)]
        at = about(axis, share * angle) @ rotation(*here[3:])
        joints = inverse((*point, *angles(at)), found[-1], offset)
        if joints is None:
            return None
        found.append(joints)
    return Line(tuple(found), Planned((0.0,), (length,), speed, acceleration, now))


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    """Return the rotation by `angle` [rad] about a unit vector, (3, 3)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turned: np.ndarray = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return turned
