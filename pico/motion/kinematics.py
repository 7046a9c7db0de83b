"""Forward and inverse kinematics of the xArm7 in plain Python floats: no numpy, no mujoco.

With the tool vertical and joints 3 and 5 at zero the arm is planar: upper arm and forearm are two links that turn in
the vertical plane that joint 1 sets. In that plane (r outward, z up, angles from the vertical towards r) the joints
stand at

    elbow = shoulder + A rot(q2),   wrist = elbow + B rot(q2 - q4),   tool center = wrist + (76, -97 - tool)

where A = (52.5, 293), B = (77.5, -342.5) [mm], and q6 = q4 - q2 keeps the tool vertical. Solving the triangle gives
at most two elbows for each of two bearings of joint 1.
"""

from __future__ import annotations

import math

from pico.model.lab import Robot
from pico.motion.types import Joints
from pico.motion.xarm7 import LIMITS, ORIGINS, ROLLS, within_limits

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]

_SHOULDER = ORIGINS[0][2]
_UPPER = (ORIGINS[3][0], -ORIGINS[2][1])
_FORE = (ORIGINS[4][0], ORIGINS[4][1])
_WRIST = (ORIGINS[6][0], -ORIGINS[6][1])
_UPPER_LENGTH, _FORE_LENGTH = math.hypot(*_UPPER), math.hypot(*_FORE)
_UPPER_ANGLE, _FORE_ANGLE = math.atan2(*_UPPER), math.atan2(*_FORE)  # from the vertical, towards r
_TURN = 2 * math.pi
_ROUNDING = 1e-9


def fk(joints: Joints, tool: float = 172.0) -> tuple[Vector, Matrix]:
    """Return the tool center point [mm] and the tool's rotation matrix in the base frame.

    The tool's z points out of the flange, its y is the direction in which the jaws close; `tool` [mm] is the distance
    of the tool center point from the flange.
    """
    p: Vector = (0.0, 0.0, 0.0)
    x: Vector = (1.0, 0.0, 0.0)  # the columns of the rotation matrix
    y: Vector = (0.0, 1.0, 0.0)
    z: Vector = (0.0, 0.0, 1.0)
    for (ox, oy, oz), roll, q in zip(ORIGINS, ROLLS, joints, strict=True):
        p = _sum(p, ox, x, oy, y, oz, z)
        if roll == 90:
            y, z = z, _scaled(y, -1.0)
        elif roll == -90:
            y, z = _scaled(z, -1.0), y
        c, s = math.cos(q), math.sin(q)
        x, y = _sum((0.0, 0.0, 0.0), c, x, s, y, 0.0, z), _sum((0.0, 0.0, 0.0), -s, x, c, y, 0.0, z)
    p = _sum(p, 0.0, x, 0.0, y, tool, z)
    x, y = _scaled(x, -1.0), _scaled(y, -1.0)  # the gripper is mounted half a turn about the flange's axis
    return p, ((x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2]))


def tool_pose(robot: Robot, joints: Joints) -> tuple[float, float, float, float]:
    """Return where a vertical tool is on the table: x, y, z of its center point [mm], and the yaw [deg] in which the
    jaws close."""
    (x, y, z), rotation = fk(joints, robot.gripper.tool)
    mount = robot.mount
    c, s = math.cos(math.radians(mount.yaw)), math.sin(math.radians(mount.yaw))
    yaw = mount.yaw + math.degrees(math.atan2(rotation[1][1], rotation[0][1]))
    return mount.x + c * x - s * y, mount.y + s * x + c * y, mount.z + z, math.remainder(yaw, 360.0)


def ik(robot: Robot, x: float, y: float, z: float, yaw: float) -> tuple[Joints, ...]:
    """Return every joint vector within limits that holds the tool vertical at (x, y, z) [mm, table frame].

    `yaw` [deg, table frame] is the direction in which the jaws close; the part in hand turns with it, so `yaw` and
    `yaw` + 180 are different answers here. Whole turns of joints 1 and 7 are listed; joints 3 and 5 are zero.
    The nearest to an outstretched, unwound arm comes first. Empty where the point is out of reach.
    """
    mount = robot.mount
    dx, dy = x - mount.x, y - mount.y
    radius, bearing = math.hypot(dx, dy), math.atan2(dy, dx) - math.radians(mount.yaw)
    turn = math.radians(yaw - mount.yaw) - math.pi / 2
    height = z - mount.z + robot.gripper.tool
    found = []
    for reach, q1 in ((radius, bearing), (-radius, bearing + math.pi)):
        for q2, q4 in planar(reach, height):
            for a in _turns(q1, 0):
                for b in _turns(a - turn, 6):
                    joints = (a, q2, 0.0, q4, 0.0, q4 - q2, b)
                    if within_limits(joints):
                        found.append(joints)
    return tuple(sorted(found, key=_unwound))


def planar(reach: float, height: float) -> tuple[tuple[float, float], ...]:
    """Return joints 2 and 4 [rad] that bring the vertical tool's flange to `reach`, `height` [mm] in the arm's plane,
    seen from the base; limits are not looked at."""
    r, z = reach - _WRIST[0], height - _WRIST[1] - _SHOULDER
    square = r * r + z * z
    if square == 0.0:
        return ()
    distance = math.sqrt(square)
    cosine = (_UPPER_LENGTH**2 + square - _FORE_LENGTH**2) / (2 * _UPPER_LENGTH * distance)
    if abs(cosine) > 1.0:
        return ()
    direction, opening = math.atan2(r, z), math.acos(cosine)
    found = []
    for upper in (direction - opening, direction + opening):
        elbow_r, elbow_z = _UPPER_LENGTH * math.sin(upper), _UPPER_LENGTH * math.cos(upper)
        fore = math.atan2(r - elbow_r, z - elbow_z)
        q2 = math.remainder(upper - _UPPER_ANGLE, _TURN)
        q4 = q2 - math.remainder(fore - _FORE_ANGLE, _TURN)
        low = LIMITS[3][0] - _ROUNDING
        found.append((q2, low + (q4 - low) % _TURN))
    return tuple(found)


def farthest(robot: Robot, z: float) -> float:
    """Return how far from the base's axis a vertical tool reaches at height `z` [mm] above the table; 0 where it
    doesn't."""
    height = z - robot.mount.z + robot.gripper.tool - _WRIST[1] - _SHOULDER
    length = _UPPER_LENGTH + _FORE_LENGTH
    if abs(height) >= length:
        return 0.0
    outer = math.sqrt(length**2 - height**2) + _WRIST[0]
    reached = [r for r in (outer - 0.1 * i for i in range(int(outer * 10))) if _reaches(robot, r, z)]
    return reached[0] if reached else 0.0


def _reaches(robot: Robot, reach: float, z: float) -> bool:
    solutions = planar(reach, z - robot.mount.z + robot.gripper.tool)
    return any(within_limits((0.0, q2, 0.0, q4, 0.0, q4 - q2, 0.0)) for q2, q4 in solutions)


def _turns(angle: float, joint: int) -> list[float]:
    """`angle` and whole turns of it within the limits of `joint` (from 0), the least turned first."""
    angle = math.remainder(angle, _TURN)
    low, high = LIMITS[joint]
    return sorted((a for a in (angle - _TURN, angle, angle + _TURN) if low <= a <= high), key=abs)


def _unwound(joints: Joints) -> tuple[float, ...]:
    return (round(abs(joints[0]) + abs(joints[6]), 9), *joints)


def _scaled(v: Vector, f: float) -> Vector:
    return f * v[0], f * v[1], f * v[2]


def _sum(p: Vector, a: float, x: Vector, b: float, y: Vector, c: float, z: Vector) -> Vector:
    return (
        p[0] + a * x[0] + b * y[0] + c * z[0],
        p[1] + a * x[1] + b * y[1] + c * z[1],
        p[2] + a * x[2] + b * y[2] + c * z[2],
    )
