"""Picking, carrying and placing one component by friction, step by step as a real cell would do it.

Above the goal the part's pose in the hand is measured (exactly, for now), and the goal is shifted so that the part, not
the hand, comes to stand where it should. It is measured once more just over the table: on the way down the part slides
between the fingers by a few tenths of a millimetre.
"""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass, field
from typing import Any

from pico.diagnostics import Diagnostic, error
from pico.model.lab import Robot
from pico.model.pose import Pose, angle_between
from pico.motion.kinematics import Column, columns, tool_pose
from pico.motion.types import Joints, MovePath, Segment
from pico.twin.physics import Twin
from pico.twin.placement import Placement

Steps = Generator[float, None, None]

CHUNK = 0.1
"""An operation in progress is resumed at least this often [s], to see whether the part is still in the hand."""
SETTLE = 0.1
"""Time between two corrections of an arm at rest [s]: two time constants of its servos."""
ROUNDS = 3
CLOSE = 5e-5
"""An arm is where it should be within this [rad]: at the tool about 0.01 mm."""
AIMED = 0.01
"""A part in the hand is above its goal within this [mm, deg]."""
AIM_SECONDS = 0.25
"""How long the arm takes for the shift of the goal."""
HOVER = 2.0
"""Height above the table at which a part is measured for the last time [mm]."""
CLEARANCE = 0.05
"""Height above the table at which a part is let go [mm]."""
STILL = 0.2
"""What is slower rests [mm/s]."""
TOPPLED = 5.0
"""A part that leans more than this does not stand [deg]."""
FALLEN = -20.0
"""A part whose base is lower than this has left the table [mm]."""


class Lost(Exception):
    """A part that is not where it should be: missed, dropped, toppled. Carries the diagnostic."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.summary)


def walk(twin: Twin, robot: str, segments: tuple[Segment, ...]) -> Steps:
    """Drive an arm along `segments` and bring it to rest, its fingers as they are."""
    for segment in segments:
        twin.drive(robot, segment.times, segment.joints)
        yield from _pass(segment.seconds)
    yield from settle(twin, robot)


def settle(twin: Twin, robot: str) -> Steps:
    """Wait until an arm is where it should be, correcting its set-points by what is missing."""
    for _ in range(ROUNDS):
        yield SETTLE
        if twin.trim(robot) < CLOSE:
            return
    yield SETTLE


def _pass(seconds: float) -> Steps:
    """Let time pass, in chunks."""
    count = max(1, math.ceil(seconds / CHUNK - 1e-9))
    for _ in range(count):
        yield seconds / count


@dataclass
class Handling:
    """One pick and place of `component` by an arm along `path`, to come to rest at `goal`."""

    twin: Twin
    robot: Robot
    component: str
    path: MovePath
    goal: Pose
    _carrying: bool = field(default=False, init=False)

    def run(self) -> Generator[float, None, dict[str, Any]]:
        """Do it; raises Lost with the hand open and above the table.

        Returns `error_mm` and `error_deg`, how far from the goal the part came to rest, and `correction_mm` and
        `correction_deg`, by how much the goal was shifted for the pose in the hand.
        """
        legs = {segment.name: segment for segment in self.path.segments}
        yield from self._pick(legs["approach"], legs["descend"], legs["grip"])
        self._carrying = True
        yield from self._follow(legs["lift"])
        yield from self._follow(legs["transit"])
        yield from settle(self.twin, self.path.robot)
        yield from self._watch()
        correction = self._off()
        column = yield from self._aim()
        yield from self._follow(self._shifted(legs["lower"], column, self._touch_down() + HOVER))
        yield from settle(self.twin, self.path.robot)
        column = yield from self._aim()
        yield from self._put_down(column)
        self._carrying = False
        self.twin.grip(self.path.robot, legs["release"].opening)
        yield from _pass(legs["release"].seconds)
        yield from self._follow(self._shifted(legs["retreat"], column, None))
        yield from self._rest()
        if _lies(self.twin.placement(self.component)):
            yield from self._lose("toppled", f"{self.component} toppled when {self.path.robot} let go of it")
        error_mm, error_deg = self._off()
        return {
            "error_mm": error_mm,
            "error_deg": error_deg,
            "correction_mm": correction[0],
            "correction_deg": correction[1],
        }

    def _pick(self, approach: Segment, descend: Segment, grip: Segment) -> Steps:
        self.twin.grip(self.path.robot, approach.opening)
        yield from self._follow(approach)
        self.twin.grip(self.path.robot, descend.opening)
        yield from self._follow(descend)
        yield from settle(self.twin, self.path.robot)
        self.twin.grip(self.path.robot)
        yield from _pass(grip.seconds + CHUNK)
        if self.twin.gripped(self.path.robot) != self.component:
            text = f"{self.path.robot} missed {self.component}: its fingers closed on nothing"
            yield from self._lose("missed-grasp", text)

    def _follow(self, segment: Segment) -> Steps:
        """Drive the arm along a segment, and see all the time whether the part still is in the hand."""
        self.twin.drive(self.path.robot, segment.times, segment.joints)
        for wait in _pass(segment.seconds):
            yield wait
            yield from self._watch(segment.name)

    def _watch(self, phase: str = "transit") -> Steps:
        if self._carrying and self.twin.gripped(self.path.robot) != self.component:
            text = f"{self.path.robot} dropped {self.component} on the {phase}: it slid out of the fingers"
            yield from self._lose("dropped", text)

    def _off(self) -> tuple[float, float]:
        """How far the part is from its goal, seen from above [mm, deg]."""
        pose = self.twin.placement(self.component).pose
        return pose.distance(self.goal), abs(angle_between(self.goal.yaw, pose.yaw))

    def _aim(self) -> Generator[float, None, Column]:
        """Bring the part in the hand over the goal; return the vertical on which the hand is then."""
        joints = self.twin.joints(self.path.robot)
        x, y, z, yaw = tool_pose(self.robot, joints)
        column = self._column(Pose(x, y, yaw), z, joints)
        for _ in range(ROUNDS):
            if max(self._off()) < AIMED:
                break
            x, y, _, yaw = tool_pose(self.robot, self.twin.joints(self.path.robot))
            in_hand = Pose(x, y, yaw).inverse().compose(self.twin.placement(self.component).pose)
            column = self._column(self.goal.compose(in_hand.inverse()), z, joints)
            target = column.at(z)
            assert target is not None  # `_column` looked
            start = self.twin.joints(self.path.robot)
            self.twin.drive(self.path.robot, *_eased(start, target))
            yield from _pass(AIM_SECONDS)
            yield from settle(self.twin, self.path.robot)
            yield from self._watch()
        return column

    def _put_down(self, column: Column) -> Steps:
        """Lower the part the last little way, and wait until the arm rests."""
        start = self.twin.joints(self.path.robot)
        end = column.at(self._touch_down())
        self.twin.drive(self.path.robot, *_eased(start, end or start))
        yield from _pass(AIM_SECONDS)
        yield from settle(self.twin, self.path.robot)
        yield from self._watch("lower")

    def _column(self, tool: Pose, z: float, near: Joints) -> Column:
        """The posture over `tool` that is nearest to `near`; raises Lost at the end of the reach."""
        found = [
            (max(abs(a - b) for a, b in zip(joints, near, strict=True)), number, column)
            for number, column in enumerate(columns(self.robot, tool.x, tool.y, tool.yaw))
            if (joints := column.at(z)) is not None
        ]
        if not found:
            text = f"{self.path.robot} cannot reach {tool}, where it must hold {self.component} for its goal"
            raise Lost(error("unreachable", text, address=self.component))
        return min(found)[2]

    def _touch_down(self) -> float:
        """The height of the tool at which the part in the hand nearly touches the table [mm]."""
        z = tool_pose(self.robot, self.twin.joints(self.path.robot))[2]
        return z - self.twin.placement(self.component).position[2] * 1000 + CLEARANCE

    def _shifted(self, segment: Segment, column: Column, end: float | None) -> Segment:
        """The vertical `segment` on another column; its last height becomes `end` [mm] where that is given."""
        heights = [tool_pose(self.robot, joints)[2] for joints in segment.joints]
        if end is None:
            start, end = tool_pose(self.robot, self.twin.joints(self.path.robot))[2], heights[-1]
        else:
            start = heights[0]
        scale = (end - start) / (heights[-1] - heights[0])
        moved = [column.at(start + scale * (z - heights[0])) for z in heights]
        joints = tuple(new or old for new, old in zip(moved, segment.joints, strict=True))
        return Segment(segment.name, segment.times, joints, segment.opening)

    def _rest(self) -> Steps:
        """Wait until the part rests or has left the table, 3 s at most."""
        for _ in range(round(3 / CHUNK)):
            yield CHUNK
            if self.twin.speed(self.component) < STILL or self.twin.placement(self.component).position[2] < -1.0:
                return

    def _lose(self, code: str, text: str) -> Steps:
        """Open the hand, bring it up, wait until the part rests, and say where it is."""
        self._carrying = False
        self.twin.hold(self.path.robot)
        self.twin.grip(self.path.robot, self.robot.gripper.stroke)
        yield from self._rest()
        yield from self._withdraw()
        where, hint = whereabouts(self.component, self.twin.placement(self.component))
        raise Lost(error(code, f"{text}; {where}", hint=hint, address=self.component))

    def _withdraw(self) -> Steps:
        """Bring the hand straight up to the transit height."""
        joints = self.twin.joints(self.path.robot)
        x, y, z, yaw = tool_pose(self.robot, joints)
        top = self.robot.transit_height
        if z > top - 1.0:
            return
        column = self._column(Pose(x, y, yaw), z, joints)
        way = [joints] + [column.at(z + (top - z) * i / 40) or joints for i in range(1, 41)]
        times = tuple(0.05 * i for i in range(41))
        yield from walk(self.twin, self.path.robot, (Segment("retreat", times, tuple(way), self.robot.gripper.stroke),))


def whereabouts(component: str, placement: Placement) -> tuple[str, str]:
    """Return where a part is, in words, and what to do about it."""
    by_hand = f"put it upright by hand (`pico sim nudge {component}` in the simulator), then plan again"
    pose = placement.pose
    if placement.position[2] * 1000 < FALLEN:
        return "it fell off the table", by_hand
    if _lies(placement):
        return f"it lies on its side at x = {pose.x:.0f}, y = {pose.y:.0f}", by_hand
    tidy = Pose(round(pose.x, 1) + 0.0, round(pose.y, 1) + 0.0, round(pose.yaw, 1) + 0.0)
    return f"it stands at {tidy}", "plan again: it starts from what stands on the table now"


def _lies(placement: Placement) -> bool:
    return placement.tilt > TOPPLED


def _eased(start: Joints, end: Joints) -> tuple[tuple[float, ...], tuple[Joints, ...]]:
    """Times and joints of a short motion that starts and ends gently."""
    count = 20
    shares = [(1 - math.cos(math.pi * i / count)) / 2 for i in range(count + 1)]
    joints = [tuple(a + s * (b - a) for a, b in zip(start, end, strict=True)) for s in shares]
    return tuple(AIM_SECONDS * i / count for i in range(count + 1)), tuple(joints)
