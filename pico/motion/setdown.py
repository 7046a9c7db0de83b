"""The ways of an arm with a part that it already holds: up, over, down, release, up, the rest of a move that was cut
short; and those of a part that a person steers: lifted by a hair, shifted in small steps, set down where it is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace

from pico.geometry.tethers import turn_between
from pico.model.catalog import Geometry
from pico.model.pose import Pose
from pico.model.robot import Robot
from pico.motion import gantry, timing
from pico.motion.explain import blocked
from pico.motion.kinematics import Column, columns, tool_of, tool_pose
from pico.motion.moves import Move, Postures, ascend, legs, turned
from pico.motion.paths import Stand, distance, postures, stand, swing
from pico.motion.reach import grasp_height, opening
from pico.motion.scene import Hit, Scene
from pico.motion.types import Blocked, Joints, MovePath, Segment, StandingObject
from pico.teleop.frames import STEP_SECONDS
from pico.teleop.steps import SLOW

SWING = 3.0
"""What is held swings by no more than this between the jaws [mm]."""
HAIR = 3.0
"""How far above its place a part is held while it is steered [mm]: what slides between the fingers does not touch."""
NEAR = 0.5
"""How far a joint may go in one step [rad]: more is another posture."""
ROOM = 1.2
"""A step may take so much longer than STEP_SECONDS, and no more."""
_AT_REST = 0.02
"""How long a segment takes in which nothing moves [s]."""
_SAME = 1e-6  # mm


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
    others = {n: t for n, t in standing.items() if n != component}
    if struck := gantry.overlapped(component, geometry, goal, others):
        return struck
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


def slowly(scene: Scene) -> Scene:
    """Return a scene whose robot goes no faster than while a person steers it; it shares all else with `scene`."""
    found = copy(scene)
    found.robot = replace(scene.robot, tool_speed=min(scene.robot.fastest, SLOW))
    return found


class Taking(Move):
    """Taking a part in hand where it stands: `start` is `goal`, as all that lets it down there is looked at, too."""

    def _timed(self, rise: list[Joints], approach: list[Joints], transit: list[Joints], choice: Postures) -> MovePath:
        """The way down to the part, the grip, and up by a hair."""
        self.scene = slowly(self.scene)
        whole = super()._timed(rise, approach, transit, choice)
        lift = timing.vertical(self.scene.robot, choice.pick, self.low, self.low + HAIR)
        down = [segment for segment in whole.segments if segment.name in ("approach", "descend", "grip")]
        return replace(whole, segments=(*down, Segment("lift", *timing.steady(lift), self.width)))


class Shifting(Move):
    """One step in the plane with what is held: `start` is where it is meant to be now, `joints` where the arm is."""

    def find(self) -> MovePath | Blocked:
        """Return the step, rest to rest, straight and at one height; or what keeps it from being made."""
        self._enter("lower")
        robot, height = slowly(self.scene).robot, tool_pose(self.scene.robot, self.joints)[2]
        in_hand = tool_of(robot, self.joints).inverse().compose(self.start)
        there = nearest(self.scene, self.goal.compose(in_hand.inverse()), height, self.joints)
        if there is None:
            return Blocked("reach", f"{self.scene.name} does not reach farther with {self.component} in its hand here")
        now, hit = self.scene.look(self.joints)[1], swing(self.scene, self.joints, there)
        if hit is not None and not (now is not None and hit.missing <= now.missing + _SAME):  # away from it is free
            return _near(self, hit)
        times, way = timing.straight(robot, self.joints, there)
        if times[-1] > ROOM * STEP_SECONDS:
            text = f"a step of that size takes {times[-1]:.2g} s here, and may take {STEP_SECONDS:g} s"
            return Blocked("reach", text, help="take a smaller step")
        if len(times) == 1:
            times, way = (0.0, _AT_REST), (self.joints, self.joints)
        return MovePath(self.scene.name, self.component, (Segment("transit", times, way, self.width),))


class LettingGo(Move):
    """Setting down what is held where it is: straight down, open, straight up; `start` is `goal`."""

    def find(self) -> MovePath | Blocked:
        """Return the way down and up, or what is in it."""
        _, _, height, _ = tool_pose(self.scene.robot, self.joints)
        joints = nearest(self.scene, tool_of(self.scene.robot, self.joints), height, self.joints)
        column = stand(self.scene, joints).column if joints else None
        if joints is None or column is None:
            return Blocked("reach", f"{self.scene.name} does not hold {self.component} upright")
        failed = self._vertical("place", column)
        if failed is not None:
            return blocked(self.errand, *failed)
        return self._down(joints, column, height)

    def _down(self, joints: Joints, column: Column, height: float) -> MovePath:
        robot = slowly(self.scene).robot
        jaws, ground = timing.grip_seconds(robot, self.geometry), column.at(self.low)
        assert ground is not None  # `_vertical` went there
        rest = (0.0, _AT_REST), (self.joints, joints)
        lower = timing.steady(timing.vertical(robot, column, height, self.low), timing.CORRECTING)
        segments = (
            Segment("lift", *rest, self.width),
            Segment("transit", (0.0, _AT_REST), (joints, joints), self.width),
            Segment("lower", *lower, self.width),
            Segment("release", (0.0, jaws), (ground, ground), self.opening),
            Segment("retreat", *timing.vertical(robot, column, self.low, self.high), self.opening),
        )
        return MovePath(self.scene.name, self.component, segments)


def nearest(scene: Scene, tool: Pose, height: float, joints: Joints) -> Joints | None:
    """Return the upright posture over `tool` at a height [mm] that is nearest to `joints`; None where none is near."""
    found = [
        (max(abs(a - b) for a, b in zip(q, joints, strict=True)), q)
        for column in columns(scene.robot, tool.x, tool.y, tool.yaw)
        if (q := column.at(height)) is not None
    ]
    best = min(found, default=None)
    return best[1] if best is not None and best[0] <= NEAR else None


def _near(step: Shifting, hit: Hit) -> Blocked:
    """What stops a step, as a line says it that a person reads while steering."""
    why = blocked(step.errand, "transit", hit)
    obstacle = "the table" if hit.kind == "table" else hit.obstacle
    kept = hit.gap + hit.missing
    who = step.component if hit.part == "held" else "a finger" if hit.part == "finger" else "the arm"
    text = f"{who} is {max(0.0, hit.gap):.1f} mm before {obstacle}" + (f", of which {kept:.3g} mm stay" if kept else "")
    return replace(why, text=text)
