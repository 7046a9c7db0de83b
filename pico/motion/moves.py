"""One move of an arm: which posture to pick and place in, checked leg by leg, then timed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise

from pico.geometry.tethers import turn_between
from pico.model.catalog import Geometry
from pico.model.pose import Pose
from pico.motion import timing
from pico.motion.explain import Errand, blocked
from pico.motion.kinematics import Column, columns, tool_pose
from pico.motion.paths import Stand, distance, plumb, postures, route, stand, swing, usable
from pico.motion.reach import grasp_height, opening
from pico.motion.scene import Hit, Scene
from pico.motion.types import Blocked, Joints, MovePath, Segment, SegmentName, StandingObject

STRAIGHT_TRIES = 12
"""Pairs of postures tried with straight swings only."""
DETOUR_TRIES = 4
"""Pairs tried with ways around after that."""
WOUND = 0.02
"""What a turn of joints 1 and 7 away from zero counts where ways are else alike."""
STRAIGHTENED = 0.02
"""A tool that was stopped askew is made plumb on the spot where no joint turns by more than this for it [rad]."""
_TOUCHING = -1.0
"""Gap [mm] down to which a part that is lifted may seem to overlap a neighbor: parts that touch, seen with error."""
_JAW_GAP = 1.0
"""How much wider than the part the pads are when the closing grip is checked [mm]."""


@dataclass(frozen=True, slots=True)
class Postures:
    """The postures of a move: over the pick, over the place."""

    pick: Column
    place: Column


@dataclass
class Move:
    """A move under search. Looks at the scene are remembered: the same vertical or swing is never checked twice."""

    scene: Scene
    component: str
    geometry: Geometry
    start: Pose
    goal: Pose
    grasp_yaw: float
    standing: Mapping[str, StandingObject]
    joints: Joints
    _verticals: dict[tuple[str, float, int], tuple[SegmentName, Hit] | None] = field(default_factory=dict)
    _swings: dict[tuple[str, Joints, Joints], Hit | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        grasp = self.geometry.grasp
        assert grasp is not None  # the caller asked `check_grip`
        self.low, self.high = grasp_height(self.scene.robot, self.geometry), self.scene.robot.transit_height
        self.width, self.opening = grasp.width, opening(self.scene.robot, self.geometry)
        self.others = {name: thing for name, thing in self.standing.items() if name != self.component}
        self.errand = Errand(self.scene.name, self.component, self.start, self.goal)

    def find(self) -> MovePath | Blocked:
        """Return the first clear move, straight swings before detours, the shortest first; else why the best fails."""
        self._enter("approach")
        rise = ascend(self.scene, self.joints, self.standing)
        if isinstance(rise, Hit):
            return blocked(self.errand, "approach", rise)
        above = stand(self.scene, rise[-1])
        choices = self._choices(above.joints)
        if not choices:
            text = f"{self.scene.name} can't carry {self.component} from {self.start} to {self.goal}: its joints end"
            return Blocked("reach", text)
        reason: Blocked | None = None
        for detours, tries in ((False, STRAIGHT_TRIES), (True, DETOUR_TRIES)):
            for choice in choices[:tries]:
                found = self._attempt(above, choice, detours)
                if not isinstance(found, Blocked):
                    return self._timed(rise, *found, choice)
                reason = reason or found
        assert reason is not None
        return reason

    def _choices(self, above: Joints) -> list[Postures]:
        """Pairs of postures in which the part keeps its place between the jaws, by how far the joints go."""
        pairs = []
        turn = turn_between(self.scene.setup, self.component, self.start, self.goal)
        for half in (0.0, 180.0):
            picks, places = (
                postures(self.scene.robot, pose, self.grasp_yaw + half, self.low) for pose in (self.start, self.goal)
            )
            for pick, up in picks:
                first = distance(above, up)
                for place, down in places:
                    if turn is not None and abs(turned(pick, place) - turn) > 1.0:
                        continue  # the other way around, which would wind the part's cable by a whole turn
                    wound = abs(place.q1) + abs(place.q7)
                    pairs.append((round(first + distance(up, down) + WOUND * wound, 9), Postures(pick, place)))
        return [choice for _, choice in sorted(pairs, key=lambda pair: pair[0])]

    def _attempt(self, above: Stand, choice: Postures, detours: bool) -> tuple[list[Joints], list[Joints]] | Blocked:
        for kind, column in (("pick", choice.pick), ("place", choice.place)):
            failed = self._vertical(kind, column)
            if failed is not None:
                return blocked(self.errand, *failed)
        pick, place = (Stand(_top(c, self.high), c) for c in (choice.pick, choice.place))
        approach = self._way("approach", above, pick, detours)
        if isinstance(approach, Hit):
            return blocked(self.errand, "approach", approach)
        transit = self._way("transit", pick, place, detours)
        if isinstance(transit, Hit):
            return blocked(self.errand, "transit", transit)
        return approach, transit

    def _way(self, phase: SegmentName, start: Stand, end: Stand, detours: bool) -> list[Joints] | Hit:
        key = (phase, start.joints, end.joints)
        if key not in self._swings:
            self._enter(phase)
            self._swings[key] = swing(self.scene, start.joints, end.joints)
        hit = self._swings[key]
        if hit is None:
            return [start.joints, end.joints]
        if not detours:
            return hit
        self._enter(phase)
        return route(self.scene, start, end)

    def _vertical(self, kind: str, column: Column) -> tuple[SegmentName, Hit] | None:
        """Check what happens on a column; whole turns of the joints make no difference to it."""
        key = (kind, round(column.reach, 3), column.elbow)
        if key not in self._verticals:
            phases: tuple[SegmentName, ...] = ("descend", "grip", "lift") if kind == "pick" else ("lower", "retreat")
            self._verticals[key] = next((f for phase in phases if (f := self._phase(phase, column))), None)
        return self._verticals[key]

    def _phase(self, phase: SegmentName, column: Column) -> tuple[SegmentName, Hit] | None:
        self._enter(phase)
        hit = plumb(self.scene, column, self.low, self.low if phase == "grip" else self.high)
        return (phase, hit) if hit is not None else None

    def _enter(self, phase: SegmentName) -> None:
        """Arrange the scene as it is while the arm does `phase`."""
        scene, margins = self.scene, self.scene.setup.lab.margins
        carrying = phase in ("lift", "transit", "lower")
        there = self.others
        if not carrying:
            pose = self.goal if phase == "retreat" else self.start
            there = self.others | {self.component: StandingObject(pose, self.geometry)}
        scene.arrange(there)
        scene.hold(self.geometry if carrying else None, self.grasp_yaw)
        scene.ignored = frozenset([self.component] if self.scene.robot.gripper.fingers == "none" else [])  # sucked at
        scene.open(self.width if carrying else self.width + _JAW_GAP if phase == "grip" else self.opening)
        scene.required["held"] = _TOUCHING if phase == "lift" else margins.body
        scene.required["finger"] = 0.0 if phase == "grip" else margins.fingers

    def _timed(self, rise: list[Joints], approach: list[Joints], transit: list[Joints], choice: Postures) -> MovePath:
        robot, low, high = self.scene.robot, self.low, self.high
        jaws = timing.grip_seconds(robot, self.geometry)
        bottom, ground = _top(choice.pick, low), _top(choice.place, low)
        up, down = timing.vertical(robot, choice.place, low, high), timing.vertical(robot, choice.place, high, low)
        segments = (
            Segment("approach", *legs(self.scene, [*rise, *approach[1:]], len(rise) - 1), self.opening),
            Segment("descend", *timing.steady(timing.vertical(robot, choice.pick, high, low)), self.opening),
            Segment("grip", (0.0, jaws), (bottom, bottom), self.width),
            Segment("lift", *timing.vertical(robot, choice.pick, low, high), self.width),
            Segment("transit", *timing.steady(legs(self.scene, transit, 0)), self.width),
            Segment("lower", *timing.steady(down, timing.CORRECTING), self.width),
            Segment("release", (0.0, jaws), (ground, ground), self.opening),
            Segment("retreat", *up, self.opening),
        )
        return MovePath(self.scene.name, self.component, segments)


def turned(pick: Column, place: Column) -> float:
    """Return by how much a part in hand turns on the way from one posture to the other [deg], whole turns included."""
    return math.degrees((place.q1 - place.q7) - (pick.q1 - pick.q7))


def find_park(scene: Scene, joints: Joints, standing: Mapping[str, StandingObject]) -> MovePath | Blocked:
    """Return the way from `joints` to the robot's park pose: straight up where the arm is low, then there."""
    robot = scene.robot
    errand = Errand(scene.name)
    opened = robot.gripper.stroke / 2
    scene.arrange(standing)
    scene.hold(None)
    scene.ignored = frozenset()
    scene.open(opened)
    scene.required.update(held=scene.setup.lab.margins.body, finger=scene.setup.lab.margins.fingers)
    rise = ascend(scene, joints, standing)
    if isinstance(rise, Hit):
        return blocked(errand, "park", rise)
    found = route(scene, stand(scene, rise[-1]), stand(scene, parked(scene)))
    if isinstance(found, Hit):
        return blocked(errand, "park", found)
    way = legs(scene, [*rise, *found[1:]], len(rise) - 1)
    segment = Segment("park", *(timing.steady(way) if way[0][-1] else way), opened)
    return MovePath(scene.name, None, (segment,))


def parked(scene: Scene) -> Joints:
    """Return the robot's park pose [rad]."""
    return tuple(math.radians(q) for q in scene.robot.park)


def ascend(scene: Scene, joints: Joints, standing: Mapping[str, StandingObject]) -> list[Joints] | Hit:
    """Return corners of the way from `joints` straight up to the transit height (just `joints` where it is high
    enough), or what is in the way.

    What the hand stands around is not in the way: the arm may have been stopped over it. A tool that is tilted by
    little, as an arm is that was stopped at speed, is made plumb where it is; one that is tilted by more is first
    brought upright in the plane that the arm is in.
    """
    height = scene.robot.transit_height
    x, y, z, _ = tool_pose(scene.robot, joints)
    here = stand(scene, joints)
    here = here if here.column else _plumb(scene, joints)
    if here.column is not None and z >= height - 1.0:
        return list(dict.fromkeys((joints, here.joints)))
    if here.column is None or not usable(here.column, z, height):
        upright = _upright(scene, joints)
        hit = swing(scene, joints, upright)
        return [joints, upright] if hit is None else hit
    before = scene.ignored
    scene.ignored = frozenset(
        name for name, thing in standing.items() if thing.pose.distance(Pose(x, y)) < thing.geometry.footprint.radius
    )
    hit = plumb(scene, here.column, z, height)
    scene.ignored = before
    return list(dict.fromkeys((joints, here.joints, _top(here.column, height)))) if hit is None else hit


def _plumb(scene: Scene, joints: Joints) -> Stand:
    """The arm with its tool vertical where it is now, where that turns no joint by more than `STRAIGHTENED`; else the
    arm as it is."""
    x, y, z, yaw = tool_pose(scene.robot, joints)
    for column in columns(scene.robot, x, y, yaw):
        upright = column.at(z)
        if upright is not None and max(abs(a - b) for a, b in zip(upright, joints, strict=True)) <= STRAIGHTENED:
            return Stand(upright, column)
    return Stand(joints, None)


def _upright(scene: Scene, joints: Joints) -> Joints:
    """A posture with a vertical tool at transit height, in the plane of joint 1 and with joint 7 as it is; where the
    arm has none, `joints` themselves."""
    robot = scene.robot
    for reach in (300.0, 400.0, 200.0, 500.0, 600.0):
        column = Column(joints[0], joints[6], reach, 0, robot.gripper.tool - robot.mount.z)
        if (upright := column.at(robot.transit_height)) is not None:
            return upright
    return joints


def legs(scene: Scene, corners: list[Joints], verticals: int) -> timing.Timed:
    """Return the timed way over `corners`, resting at each; the first `verticals` legs are straight up."""
    times: list[float] = [0.0]
    postures: list[Joints] = [corners[0]]
    for number, (start, end) in enumerate(pairwise(corners)):
        column = stand(scene, start).column if number < verticals else None
        if column is not None:
            low, high = (tool_pose(scene.robot, q)[2] for q in (start, end))
            more, way = timing.vertical(scene.robot, column, low, high)
        else:
            more, way = timing.straight(scene.robot, start, end)
        began = times[-1]
        times += [began + t for t in more[1:]]
        postures += way[1:]
    if len(times) == 1:
        return (0.0, 0.0), (corners[0], corners[0])
    return tuple(times), tuple(postures)


def _top(column: Column, z: float) -> Joints:
    joints = column.at(z)
    if joints is None:
        raise ValueError(f"the arm can't hold its tool vertical at {z:.0f} mm here")
    return joints
