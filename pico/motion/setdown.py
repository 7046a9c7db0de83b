"""The way of an arm that already holds a part: up, over, down, release, up: the rest of a move that was cut short."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from pico.geometry.shape import placed, separation
from pico.geometry.tethers import turn_between
from pico.model.catalog import Geometry
from pico.model.lab import Robot
from pico.model.pose import Pose
from pico.motion import gantry, timing
from pico.motion.explain import blocked
from pico.motion.kinematics import Column, tool_of
from pico.motion.moves import Move, ascend, legs, turned
from pico.motion.paths import Stand, distance, postures, stand
from pico.motion.reach import grasp_height, opening
from pico.motion.scene import Hit
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject

SWING = 3.0
"""What is held swings by no more than this between the jaws [mm]."""


def tool_goal(robot: Robot, joints: Joints, held: Pose, goal: Pose) -> Pose:
    """Return where the tool must be for the part that is `held` now to be at `goal`.

    Jaws center what they hold: where it was seen a little off their middle, the arm was stopped at speed, and it swings
    back.
    """
    in_hand = tool_of(robot, joints).inverse().compose(held)
    if robot.gripper.fingers != "none" and abs(in_hand.x) <= SWING:
        in_hand = replace(in_hand, x=0.0)
    return goal.compose(in_hand.inverse())


@dataclass
class SetDown(Move):
    """Setting down what is held: `start` is where the part is now, seen from above, `joints` where the arm is."""

    def find(self) -> MovePath | Blocked:
        """Return the first clear way to the goal, the shortest first; else why the best fails."""
        self._enter("lift")
        rise = ascend(self.scene, self.joints, self.others)
        if isinstance(rise, Hit):
            return blocked(self.errand, "lift", rise)
        above = stand(self.scene, rise[-1])
        choices = self._columns(above)
        reason: Blocked | None = None
        for detours in (False, True):
            for column, top in choices:
                found = self._onto(above, Stand(top, column), detours)
                if not isinstance(found, Blocked):
                    return self._path(rise, found, column)
                reason = reason or found
        text = f"{self.scene.name} can't bring {self.component}, which it holds, to {self.goal}: its joints end"
        return reason or Blocked("reach", text)

    def _columns(self, above: Stand) -> list[tuple[Column, Joints]]:
        """The postures over the goal, by how far the joints go; a part on a cable turns the way it may."""
        tool = tool_goal(self.scene.robot, self.joints, self.start, self.goal)
        found = postures(self.scene.robot, tool, 0.0, self.low)
        turn = turn_between(self.scene.setup, self.component, self.start, self.goal)
        if turn is not None and above.column is not None:
            now = above.column
            found = [(c, top) for c, top in found if abs(turned(now, c) - turn) <= 1.0]
        return sorted(found, key=lambda choice: (round(distance(above.joints, choice[1]), 9), choice[1]))

    def _onto(self, above: Stand, place: Stand, detours: bool) -> list[Joints] | Blocked:
        assert place.column is not None
        failed = self._vertical("place", place.column)
        if failed is not None:
            return blocked(self.errand, *failed)
        way = self._way("transit", above, place, detours)
        return blocked(self.errand, "transit", way) if isinstance(way, Hit) else way

    def _path(self, rise: list[Joints], transit: list[Joints], column: Column) -> MovePath:
        robot, low, high = self.scene.robot, self.low, self.high
        jaws = timing.grip_seconds(robot, self.geometry)
        ground = column.at(low)
        assert ground is not None  # `postures` looked
        return _segments(
            self.scene.name, self.component,
            legs(self.scene, rise, len(rise) - 1), timing.steady(legs(self.scene, transit, 0)),
            timing.steady(timing.vertical(robot, column, high, low), timing.CORRECTING),
            ((0.0, jaws), (ground, ground)),
            timing.vertical(robot, column, low, high), (self.width, self.opening),
        )  # fmt: skip


def gantry_set_down(
    name: str, robot: Robot, component: str, geometry: Geometry, held: Pose, goal: Pose,
    standing: Mapping[str, StandingObject], joints: Joints,
) -> MovePath | Blocked:  # fmt: skip
    """Return the way of a gantry over the top; blocked where the footprint at `goal` overlaps another."""
    shape = placed(geometry.footprint, goal)
    for other, thing in sorted(standing.items()):
        gap = separation(shape, placed(thing.geometry.footprint, thing.pose))
        if other != component and gap < 0:
            text = f"{component} would hit {other} by {-gap:.1f} mm, setting it down at {goal}"
            return Blocked("collision", text, "lower", other, round(-gap, 3))
    assert geometry.grasp is not None  # the caller asked `check_grip`
    width, opened = geometry.grasp.width, opening(robot, geometry)
    high, low = robot.transit_height / 1000, grasp_height(robot, geometry) / 1000
    tool = tool_goal(robot, joints, held, goal)
    x, y, turn = tool.x / 1000, tool.y / 1000, math.radians(tool.yaw)
    risen = (joints[0], joints[1], max(joints[2], high), joints[3])
    above, ground, jaws = (x, y, high, turn), (x, y, low, turn), timing.jaw_seconds(opened, width)
    return _segments(
        name, component, gantry._straight(robot, joints, risen), gantry._straight(robot, risen, above),
        gantry._straight(robot, above, ground), ((0.0, jaws), (ground, ground)),
        gantry._straight(robot, ground, above), (width, opened),
    )  # fmt: skip


def _segments(
    robot: str, component: str, lift: timing.Timed, transit: timing.Timed, lower: timing.Timed, release: timing.Timed,
    retreat: timing.Timed, openings: tuple[float, float],
) -> MovePath:  # fmt: skip
    width, opened = openings
    segments = (
        Segment("lift", *lift, width), Segment("transit", *transit, width), Segment("lower", *lower, width),
        Segment("release", *release, opened), Segment("retreat", *retreat, opened),
    )  # fmt: skip
    return MovePath(robot, component, segments)
