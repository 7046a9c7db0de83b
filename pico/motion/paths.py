"""Finding the way of one arm: down, grip, up, one straight swing in joint space, down, release, up.

The tool stays vertical: joints 3 and 5 are zero and joint 6 = joint 4 - joint 2, which is linear, so that it holds on
every straight line in joint space between two such postures. With the elbow up, such a line bows upward and never
comes lower than its lower end.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.motion.kinematics import Column, column_of, columns
from pico.motion.scene import FREE, Hit, Scene
from pico.motion.types import Joints

STEP = 0.02
"""Greatest step of a joint between two looks at the scene [rad]."""
TRAVEL = 2 * FREE
"""Greatest way of any point of the arm between two looks where nothing is near [mm]."""
FINEST = 0.25
"""Where something is near, looks are no farther apart than this [mm]."""
RISE = 10.0
"""Greatest step of the tool between two looks on a vertical [mm]."""
_UPPER, _FORE, _PALM = 300.0, 355.0, 110.0  # mm, how far a turn of joint 2, 4 or 7 carries what hangs on it
_FOLDED = (300.0, 220.0, 400.0)  # mm, distances from the base's axis to swing at where the straight way is blocked
_RAISED = (0.0, 60.0, 120.0)  # mm above the transit height, for the same


def swing(scene: Scene, start: Joints, end: Joints) -> Hit | None:
    """Return the worst hit on the straight line in joint space, or None where it is clear.

    Looks are at most STEP and TRAVEL apart, so that without anything near nothing can be passed unseen; where
    something is near, the line is halved until the distances seen at both ends cover the way between them.
    """
    way = travel(start, end)
    count = max(1, math.ceil(max(abs(b - a) for a, b in zip(start, end, strict=True)) / STEP), math.ceil(way / TRAVEL))
    gap, worst = scene.look(start)
    for i in range(1, count + 1):
        before = gap
        gap, hit = scene.look(between(start, end, i / count))
        if hit is None and worst is None and before + gap < way / count:
            hit = _refine(scene, start, end, ((i - 1) / count, i / count), (before, gap), way)
        worst = _worse(worst, hit)
    return worst


def _worse(one: Hit | None, other: Hit | None) -> Hit | None:
    if one is None or other is None:
        return one or other
    return other if other.missing > one.missing else one


def _refine(
    scene: Scene, start: Joints, end: Joints, shares: tuple[float, float], gaps: tuple[float, float], way: float
) -> Hit | None:
    middle = (shares[0] + shares[1]) / 2
    length = (shares[1] - shares[0]) * way
    if length < FINEST or sum(gaps) >= length:
        return None
    gap, hit = scene.look(between(start, end, middle))
    return (
        hit
        or _refine(scene, start, end, (shares[0], middle), (gaps[0], gap), way)
        or _refine(scene, start, end, (middle, shares[1]), (gap, gaps[1]), way)
    )


def travel(start: Joints, end: Joints) -> float:
    """Return a bound of the way that any point of the arm goes on the straight line between two postures [mm]."""
    d = [abs(b - a) for a, b in zip(start, end, strict=True)]
    reach = _UPPER + _FORE + _PALM
    lean = abs((end[1] - start[1]) - (end[3] - start[3]))
    tilt = abs((end[5] - start[5]) - (end[3] - start[3]) + (end[1] - start[1]))
    turn = d[0] * reach + d[1] * _UPPER + lean * _FORE + tilt * 2.5 * _PALM
    return turn + (d[2] + d[4]) * reach + abs((end[6] - start[6]) - (end[0] - start[0])) * _PALM


def between(start: Joints, end: Joints, share: float) -> Joints:
    """Return the posture at `share` (0 to 1) of the straight line."""
    return tuple(a + share * (b - a) for a, b in zip(start, end, strict=True))


def heights(low: float, high: float) -> list[float]:
    """Return heights from `high` down to `low`, at most RISE apart [mm]."""
    count = max(1, math.ceil((high - low) / RISE))
    return [high + (low - high) * i / count for i in range(count + 1)]


def plumb(scene: Scene, column: Column, low: float, high: float) -> Hit | None:
    """Return the worst hit on the vertical from `high` down to `low` [mm], or None where it is clear.

    The hand only shifts along z, and nothing of it is less tall than a step, so that it can't pass anything unseen.
    """
    worst = None
    for z in heights(low, high):
        joints = column.at(z)
        if joints is None:
            raise ValueError("plumb needs a column that is within limits all the way; see `usable`")
        worst = _worse(worst, scene.look(joints)[1])
    return worst


def usable(column: Column, low: float, high: float) -> bool:
    """Return whether the arm can hold its tool vertical all the way from `low` to `high` on `column`."""
    return all(column.at(z) is not None for z in heights(low, high))


def postures(robot: Robot, pose: Pose, jaws: float, low: float) -> list[tuple[Column, Joints]]:
    """Return the postures over `pose` in which the arm reaches from `low` [mm] to the transit height, with the joints
    there. `jaws` is the direction in which the jaws close in the component's frame [deg]."""
    known: dict[tuple[float, int], bool] = {}  # whole turns make no difference
    found = []
    for column in columns(robot, pose.x, pose.y, pose.yaw + jaws):
        key = (column.reach, column.elbow)
        if key not in known:
            known[key] = usable(column, low, robot.transit_height)
        if known[key] and (top := column.at(robot.transit_height)):
            found.append((column, top))
    return found


@dataclass(frozen=True, slots=True)
class Stand:
    """Where an arm is: its joints, and the column that it stands on where its tool is vertical."""

    joints: Joints
    column: Column | None


def stand(scene: Scene, joints: Joints) -> Stand:
    """Return the stand of an arm with these joints [rad]."""
    return Stand(joints, column_of(scene.robot, joints))


def route(scene: Scene, start: Stand, end: Stand) -> list[Joints] | Hit:
    """Return the corners of a clear way at transit height, the straight line where it is clear, or what blocks that.

    A way around goes over a place nearer to the base and perhaps higher: fold in, swing, reach out.
    """
    first = swing(scene, start.joints, end.joints)
    if first is None:
        return [start.joints, end.joints]
    for corners in _detours(start, end, scene.robot.transit_height):
        legs = [start.joints, *corners, end.joints]
        if all(swing(scene, a, b) is None for a, b in pairwise(legs)):
            return legs
    return first


def _detours(start: Stand, end: Stand, height: float) -> Iterator[tuple[Joints, Joints]]:
    if start.column is None or end.column is None:
        return
    for raised in _RAISED:
        for folded in (None, *_FOLDED):
            corners = [_folded(column, folded, height + raised) for column in (start.column, end.column)]
            if corners[0] and corners[1] and (raised or folded):
                yield corners[0], corners[1]


def _folded(column: Column, reach: float | None, height: float) -> Joints | None:
    if reach is None:
        return column.at(height)
    return replace(column, reach=math.copysign(min(reach, abs(column.reach)), column.reach)).at(height)


def distance(start: Joints, end: Joints) -> float:
    """Return how far the joint goes that goes farthest [rad]: what a swing's duration depends on."""
    return max(abs(b - a) for a, b in zip(start, end, strict=True))
