"""How long an arm takes from place to place where nothing is in the way: what the order of moves depends on.

Plain Python without the scene; remembered. The same postures and profiles as in `pico.motion.moves`, but each leg by
itself: the least time of its swing. Joint 7 turns twice around, so that it is never the reason for a way around; where
it is wound up and must turn back, or two legs want different postures, a real move takes longer.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, cached_property

from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.model.setup import Setup
from pico.motion import gantry, timing
from pico.motion.kinematics import Column, column_of, tool_pose
from pico.motion.paths import postures, usable
from pico.motion.reach import grasp_height, opening
from pico.motion.types import Joints
from pico.motion.xarm7 import LIMITS

USUAL_GRASP = 100.0
"""Height down to which the arm must reach where no component is named [mm]."""
_TURN = 2 * math.pi


@dataclass(frozen=True, slots=True)
class PostureOver:
    """A posture over a place: its column, and joints at transit height; joint 7 but for whole turns (of the jaws:
    half turns, where the hand is empty)."""

    column: Column
    joints: Joints


@dataclass
class Travel:
    """The times of one robot of a lab; remembers what it was asked."""

    setup: Setup
    name: str
    _over: dict[tuple[float, ...], tuple[PostureOver, ...]] = field(default_factory=dict)
    _plumb: dict[tuple[float, ...], float] = field(default_factory=dict)

    @cached_property
    def robot(self) -> Robot:
        """The robot."""
        return self.setup.lab.robots[self.name]

    @cached_property
    def parked(self) -> Joints:
        """The joints of the park pose [rad]; of a gantry [m, rad]."""
        return self.robot.park_joints

    @cached_property
    def empty(self) -> Callable[[Pose | Joints | None, Pose | None, float, float], float]:
        """See `Motion.travel`."""
        return cache(self._empty_seconds)

    @cached_property
    def carry(self) -> Callable[[str, Pose, Pose, float], float]:
        """See `Motion.carry`."""
        return cache(self._loaded_seconds)

    def _empty_seconds(
        self, start: Pose | Joints | None, goal: Pose | None, start_yaw: float, goal_yaw: float
    ) -> float:
        if start is None and goal is None:
            return 0.0
        if self.robot.model == "gantry":
            return gantry.travel(self.robot, start, goal, start_yaw, goal_yaw)
        rise = 0.0
        if isinstance(start, Pose):
            froms = [over.joints for over in self._postures(start, start_yaw, USUAL_GRASP)]
        else:
            rise, top = self._risen(start or self.parked)
            froms = [top]
        tos = [o.joints for o in self._postures(goal, goal_yaw, USUAL_GRASP)] if goal else [self.parked]
        known = froms[0][6] if not isinstance(start, Pose) and goal is not None else None
        ways = [(max(_bend(a, b), _twist(a[6], b[6], math.pi, known)), a, b) for a in froms for b in tos]
        least = min((way for way, _, _ in ways), default=math.inf) + 1e-9
        swings = (timing.swing_seconds(self.robot, a, b, way) for way, a, b in ways if way <= least)
        seconds = rise + min(swings, default=math.inf)
        return seconds + timing.STEADY if goal is None and seconds else seconds

    def _loaded_seconds(self, component: str, start: Pose, goal: Pose, grasp_yaw: float) -> float:
        robot, geometry = self.robot, self.setup.type_of(component).geometry
        if geometry.grasp is None:
            return math.inf
        low = grasp_height(robot, geometry)
        if robot.model == "gantry":
            return gantry.carry(
                robot, start, goal, low, timing.jaw_seconds(opening(robot, geometry), geometry.grasp.width)
            )
        ways = [
            (max(_bend(a.joints, b.joints), _twist(a.joints[6], b.joints[6], _TURN, None)), n, a, b)
            for n, (a, b) in enumerate(
                (a, b)
                for a in self._postures(start, grasp_yaw, low)
                for b in self._postures(goal, grasp_yaw, low)
            )
        ]  # fmt: skip
        if not ways:
            return math.inf
        way, _, pick, place = min(ways)
        verticals = sum(self._vertical(over.column, low) for over in (pick, place))
        return (
            timing.swing_seconds(robot, pick.joints, place.joints, way)
            + 2 * verticals
            + 2 * timing.grip_seconds(robot, geometry)
            + 2 * timing.STEADY
            + timing.CORRECTING
        )

    def _postures(self, pose: Pose, yaw: float, low: float) -> tuple[PostureOver, ...]:
        """The postures over a place, one for all turns of joint 7."""
        key = (pose.x, pose.y, pose.yaw, yaw, low)
        known = self._over.get(key)
        if known is None:
            found = {
                (column.q1, column.reach, column.elbow): PostureOver(column, top)
                for column, top in postures(self.robot, pose, yaw, low)
            }
            known = self._over[key] = tuple(found.values())
        return known

    def _vertical(self, column: Column, low: float) -> float:
        key = (round(column.reach, 6), column.elbow, low)
        known = self._plumb.get(key)
        if known is None:
            known = timing.vertical_seconds(self.robot, column, low, self.robot.transit_height)
            self._plumb[key] = known
        return known

    def _risen(self, joints: Joints) -> tuple[float, Joints]:
        """How long the arm takes up to transit height, and its joints there; as it is where it can't rise straight."""
        height, column = self.robot.transit_height, column_of(self.robot, joints)
        z = tool_pose(self.robot, joints)[2]
        if column is None or z >= height - 1.0 or not usable(column, z, height):
            return 0.0, joints
        return timing.vertical_seconds(self.robot, column, z, height), column.at(height) or joints


def _bend(start: Joints, end: Joints) -> float:
    """How far the joint goes that goes farthest, joint 7 left out [rad]."""
    return max(abs(b - a) for a, b in zip(start[:6], end[:6], strict=True))


def _twist(start: float, end: float, period: float, known: float | None) -> float:
    """How far joint 7 goes to where it is as at `end` but for whole periods; from `known` within its limits [rad]."""
    least = math.remainder(end - start, period)
    if known is not None and abs(known + least) > LIMITS[6][1]:
        return period - abs(least)
    return abs(least)
