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
from dataclasses import dataclass
from functools import cache, lru_cache

from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.motion.types import Joints
from pico.motion.xarm7 import LIMITS, ORIGINS, ROLLS

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
_PIECES = 8
"""Into how many pieces a straight line is cut to bound the tool's speed on it: that is then within about 1 %."""


def fk(joints: Joints, tool: float = 172.0) -> tuple[Vector, Matrix]:
    """Return the tool center point [mm] and the tool's rotation matrix in the base frame.

    The tool's z points out of the flange, its y is the direction in which the jaws close; `tool` [mm] is the distance
    of the tool center point from the flange.
    """
    p, x, y, z = _frame(joints)
    p = _sum(p, 0.0, x, 0.0, y, tool, z)
    x, y = _scaled(x, -1.0), _scaled(y, -1.0)  # the gripper is mounted half a turn about the flange's axis
    return p, ((x[0], y[0], z[0]), (x[1], y[1], z[1]), (x[2], y[2], z[2]))


def joint_at(joints: Joints, number: int) -> Vector:
    """Return where the origin of joint `number` (1 to 7) is in the base frame [mm]."""
    return _frame(joints[:number])[0]


def _frame(joints: Joints) -> tuple[Vector, Vector, Vector, Vector]:
    """The frame that hangs on the last of `joints`: its origin and its axes."""
    p: Vector = (0.0, 0.0, 0.0)
    x: Vector = (1.0, 0.0, 0.0)
    y: Vector = (0.0, 1.0, 0.0)
    z: Vector = (0.0, 0.0, 1.0)
    for (ox, oy, oz), roll, q in zip(ORIGINS, ROLLS, joints, strict=False):
        p = _sum(p, ox, x, oy, y, oz, z)
        if roll == 90:
            y, z = z, _scaled(y, -1.0)
        elif roll == -90:
            y, z = _scaled(z, -1.0), y
        c, s = math.cos(q), math.sin(q)
        x, y = _sum((0.0, 0.0, 0.0), c, x, s, y, 0.0, z), _sum((0.0, 0.0, 0.0), -s, x, c, y, 0.0, z)
    return p, x, y, z


def pace(start: Joints, end: Joints, tool: float, enough: float = 0.0) -> float:
    """Return a bound of the way that the tool center point goes per share of the straight line between two postures
    [mm], at its fastest place; where it is no more than `enough`, a coarser one.

    Close where the arm stays in its plane; what joints 3 and 5 turn or stand askew counts with the arm's length.
    """
    turns = [abs(b - a) for a, b in zip(start, end, strict=True)]
    hand = math.hypot(_WRIST[0], tool - _WRIST[1])
    long, fore = _UPPER_LENGTH + _FORE_LENGTH + hand, _FORE_LENGTH + hand
    all_out = sum(turns[:3]) * long + turns[3] * fore + (turns[4] + turns[5]) * hand
    askew = sum(max(abs(start[joint]), abs(end[joint])) for joint in (2, 4))
    out = (askew * sum(turns[:6]) + turns[2] + turns[4]) * long
    for pieces in (1, _PIECES):
        way = min(all_out, out + _planar_pace(start, end, tool, pieces))
        if way <= enough:
            break
    return way


def _planar_pace(start: Joints, end: Joints, tool: float, pieces: int) -> float:
    """The bound in the arm's plane: upper arm, forearm and hand turn by u, f, w. On each piece of the way the tool's
    distance from joint 1's axis, and the angle at the elbow, are those at its ends and what they bend in between."""
    q1, u, _, q4, _, q6, _ = (b - a for a, b in zip(start, end, strict=True))
    f, w = u - q4, u - q4 + q6
    hand, tilt = math.hypot(_WRIST[0], tool - _WRIST[1]), math.atan2(_WRIST[0], _WRIST[1] - tool)
    first = start[1] + _UPPER_ANGLE, start[1] - start[3] + _FORE_ANGLE, start[1] - start[3] + start[5] + tilt
    upper, fore, bend = _UPPER_LENGTH * abs(u), _FORE_LENGTH * abs(f), 8 * pieces**2
    same, bulge = math.copysign(1.0, u * f), (upper * abs(u) + fore * abs(f) + hand * w * w) / bend
    most, before = 0.0, (0.0, -1.0)
    for i in range(pieces + 1):
        share = i / pieces
        a, b, c = first[0] + share * u, first[1] + share * f, first[2] + share * w
        radius = abs(_UPPER_LENGTH * math.sin(a) + _FORE_LENGTH * math.sin(b) + hand * math.sin(c))
        here = radius, same * math.cos(a - b)
        cosine = min(1.0, max(here[1], before[1]) + (u - f) ** 2 / bend)
        plane = math.sqrt(max(0.0, upper * upper + fore * fore + 2 * upper * fore * cosine)) + hand * abs(w)
        most, before = max(most, math.hypot((max(here[0], before[0]) + bulge) * q1, plane)), here
    return most


def tool_pose(robot: Robot, joints: Joints) -> tuple[float, float, float, float]:
    """Return where a vertical tool is on the table: x, y, z of its center point [mm], and the yaw [deg] in which the
    jaws close."""
    (x, y, z), rotation = fk(joints, robot.gripper.tool)
    mount = robot.mount
    c, s = math.cos(math.radians(mount.yaw)), math.sin(math.radians(mount.yaw))
    yaw = mount.yaw + math.degrees(math.atan2(rotation[1][1], rotation[0][1]))
    return mount.x + c * x - s * y, mount.y + s * x + c * y, mount.z + z, math.remainder(yaw, 360.0)


def tool_point(robot: Robot, joints: Joints) -> tuple[float, float, float]:
    """Return where the tool center point of an arm or a gantry is in the table frame [mm]."""
    if robot.model == "gantry":
        return 1000 * joints[0], 1000 * joints[1], 1000 * joints[2]
    return tool_pose(robot, joints)[:3]


def tool_of(robot: Robot, joints: Joints) -> Pose:
    """Return where the tool of an arm or a gantry is, seen from above [mm, deg]."""
    if robot.model == "gantry":
        x, y, _, turn = joints
        return Pose(1000 * x, 1000 * y, math.degrees(turn))
    x, y, _, yaw = tool_pose(robot, joints)
    return Pose(x, y, yaw)


@dataclass(frozen=True, slots=True)
class Column:
    """The vertical line over a point of the table, in one posture of the arm: joints 1 and 7 [rad] hold still on it.

    `reach` is the signed distance of the line from joint 1's axis along the arm's plane, `base` what the flange is
    above the tool center point less the mount's height [mm]; `elbow` says which solution of the triangle.
    """

    q1: float
    q7: float
    reach: float
    elbow: int
    base: float

    def at(self, z: float) -> Joints | None:
        """Return the joints that hold the tool center point `z` mm above the table, or None where limits forbid."""
        solutions = planar(self.reach, z + self.base)
        if not solutions:
            return None
        q2, q4 = solutions[self.elbow]
        return (self.q1, q2, 0.0, q4, 0.0, q4 - q2, self.q7) if _bends(q2, q4) else None


def columns(robot: Robot, x: float, y: float, yaw: float) -> tuple[Column, ...]:
    """Return every posture over (x, y) [mm] with the jaws closing along `yaw` [deg], heights not looked at.

    Bearings towards the point and away from it, both elbows, whole turns of joints 1 and 7; the least turned first.
    """
    mount = robot.mount
    dx, dy = x - mount.x, y - mount.y
    radius, bearing = math.hypot(dx, dy), math.atan2(dy, dx) - math.radians(mount.yaw)
    turn = math.radians(yaw - mount.yaw) - math.pi / 2
    base = robot.gripper.tool - mount.z
    found = [
        Column(q1, q7, reach, elbow, base)
        for reach, angle in ((radius, bearing), (-radius, bearing + math.pi))
        for q1 in _turns(angle, 0)
        for q7 in _turns(q1 - turn, 6)
        for elbow in (0, 1)
    ]
    return tuple(sorted(found, key=_unwound))


def column_of(robot: Robot, joints: Joints) -> Column | None:
    """Return the column that an arm with these `joints` stands on, or None where its tool is not vertical (1e-3)."""
    q1, q2, q3, q4, q5, q6, q7 = joints
    if max(abs(q3), abs(q5), abs(q4 - q2 - q6)) > 1e-3:
        return None
    (x, y, z), _ = fk(joints, robot.gripper.tool)
    base = robot.gripper.tool - robot.mount.z
    reach = x * math.cos(q1) + y * math.sin(q1)
    for elbow, (b2, b4) in enumerate(planar(reach, z + robot.gripper.tool)):
        if max(abs(b2 - q2), abs(b4 - q4)) < 1e-3:
            return Column(q1, q7, reach, elbow, base)
    return None


def reaches(robot: Robot, x: float, y: float, z: float) -> bool:
    """Return whether a vertical tool reaches (x, y, z) [mm]; its yaw never matters, joint 7 turns twice around."""
    radius = math.hypot(x - robot.mount.x, y - robot.mount.y)
    return _reaches(robot, radius, z) or _reaches(robot, -radius, z)


@lru_cache(maxsize=8192)
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


@cache
def span(robot: Robot, z: float) -> tuple[float, float]:
    """Return the least and the greatest distance from the base's axis [mm] that a vertical tool reaches at height `z`
    [mm], to 0.5 mm; (0, 0) where it reaches nothing."""
    height = z - robot.mount.z + robot.gripper.tool - _WRIST[1] - _SHOULDER
    length = _UPPER_LENGTH + _FORE_LENGTH
    outer = math.sqrt(max(0.0, length**2 - height**2)) + _WRIST[0]
    radii = [i / 2 for i in range(int(2 * outer) + 1)]
    least = next((r for r in radii if _reaches(robot, r, z)), 0.0)
    return least, next((r for r in reversed(radii) if _reaches(robot, r, z)), 0.0)


def _reaches(robot: Robot, reach: float, z: float) -> bool:
    return any(_bends(q2, q4) for q2, q4 in planar(reach, z - robot.mount.z + robot.gripper.tool))


def _bends(q2: float, q4: float) -> bool:
    """Whether joints 2, 4 and 6 of a vertical tool are within limits."""
    (a2, b2), (a4, b4), (a6, b6) = LIMITS[1], LIMITS[3], LIMITS[5]
    return a2 <= q2 <= b2 and a4 <= q4 <= b4 and a6 <= q4 - q2 <= b6


def _turns(angle: float, joint: int) -> list[float]:
    """`angle` and whole turns of it within the limits of `joint` (from 0), the least turned first."""
    angle = math.remainder(angle, _TURN)
    low, high = LIMITS[joint]
    return sorted((a for a in (angle - _TURN, angle, angle + _TURN) if low <= a <= high), key=abs)


def _unwound(column: Column) -> tuple[float, ...]:
    return (round(abs(column.q1) + abs(column.q7), 9), column.q1, column.q7, column.elbow)


def _scaled(v: Vector, f: float) -> Vector:
    return f * v[0], f * v[1], f * v[2]


def _sum(p: Vector, a: float, x: Vector, b: float, y: Vector, c: float, z: Vector) -> Vector:
    return (
        p[0] + a * x[0] + b * y[0] + c * z[0],
        p[1] + a * x[1] + b * y[1] + c * z[1],
        p[2] + a * x[2] + b * y[2] + c * z[2],
    )
