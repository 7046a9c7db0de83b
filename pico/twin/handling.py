"""Picking, carrying and placing one component by friction, step by step as a real cell would do it.

Above the goal a camera sees where the part is in the hand, and the goal is shifted so that the part, not the hand,
comes to stand where it should. It is looked at once more just over the table: on the way down the part slides between
the fingers by a few tenths of a millimetre. Where no camera sees it, it is not placed: it goes back where it stood.

Nothing is known here but what a bench tells: joints, the distance between the pads, and what `sight` sees.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from typing import Any

from pico.diagnostics import Diagnostic, error
from pico.model.catalog import Grasp
from pico.model.pose import Pose, angle_between
from pico.model.robot import Robot
from pico.motion.kinematics import Column, columns, tool_pose
from pico.motion.timing import CORRECTING
from pico.motion.types import Joints, MovePath, Segment, SegmentName
from pico.twin.gestures import (
    FAR,
    NEARLY,
    NUDGE_SECONDS,
    Steps,
    backward,
    executing,
    nudge,
    passing,
    settle,
    steady,
    walk,
)
from pico.twin.physics import Twin
from pico.twin.sight import HandSight, InHand

HOVER = 2.0
"""Height above the table at which a part is looked at for the last time [mm]."""
CLEARANCE = 0.05
"""Height above the table at which a part is let go [mm]."""
BRIEFLY = (CORRECTING - NUDGE_SECONDS) / 2
"""What is left of the last little way for each of two times of coming to rest [s]."""
REST = 0.5
"""Time in which a part that fell comes to rest [s]."""
SLID_MM, SLID_DEG = 10.0, 10.0
"""A part that is farther than this from where the hand should have it has slipped: paths have no room for more."""


class Lost(Exception):
    """A part that is not where it should be: missed, dropped, slipped, unseen. Carries the diagnostic."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self.diagnostic = diagnostic
        super().__init__(diagnostic.summary)


@dataclass(frozen=True, slots=True)
class _Held:
    """A part seen from the tool: its pose, and its base above the tool center point [mm], a negative number."""

    pose: Pose
    base: float


@dataclass
class Handling:
    """One pick and place of `component` by an arm along `path`, to come to rest at `goal`.

    `grasp`: how wide it is between the pads. `sight` sees the part in the hand; None places it blindly, as if it were
    in the hand where the path means it to be. `stands`: where it was seen just now, if it was. `seated` is told when
    the part has been let go, and lets its seat pull it.
    """

    twin: Twin
    robot: Robot
    component: str
    grasp: Grasp
    path: MovePath
    goal: Pose
    sight: HandSight | None = None
    stands: Pose | None = None
    seated: Callable[[str], None] | None = None
    left: InHand | None = field(default=None, init=False)
    """Where the part was seen when the fingers had opened."""
    _carrying: bool = field(default=False, init=False)

    def run(self) -> Generator[float, None, dict[str, Any]]:
        """Do it; raises Lost with the hand open and above the table.

        Returns `correction_mm` and `correction_deg`, by how much the goal was shifted for the pose in the hand.
        """
        legs = {segment.name: segment for segment in self.path.segments}
        self.twin.handles[self.path.robot] = self.component
        yield from self._pick(legs)
        yield from self._follow(legs["lift"])
        yield from self._follow(legs["transit"])
        meant = self._meant(legs)
        held = yield from self._look(legs)
        correction = held.pose.distance(meant.pose), abs(angle_between(meant.pose.yaw, held.pose.yaw))
        down, column = legs["lower"].moving, self._over(held, self.goal)
        yield from self._follow(_blended(down, self._shifted(down, column, HOVER - held.base)))
        yield from self._steady(BRIEFLY)
        held = yield from self._look(legs)
        column = self._over(held, self.goal)
        yield from self._put_down(column, held)
        yield from self._let_go(legs["release"])
        self.left = self.sight.pose_in_hand(self.path.robot, self.component) if self.sight else None
        yield from self._follow(self._shifted(legs["retreat"], column, None))
        return {"correction_mm": correction[0], "correction_deg": correction[1]}

    def carry(self) -> Generator[float, None, dict[str, Any]]:
        """Do a path that ends with the part in the hand: it is picked where the path grips, else held already."""
        legs = {segment.name: segment for segment in self.path.segments}
        self.twin.handles[self.path.robot] = self.component
        yield from self._pick(legs)
        for name in ("lift", "transit"):
            if name in legs:
                yield from self._follow(legs[name])
        return {}

    def _pick(self, legs: dict[SegmentName, Segment]) -> Steps:
        robot = self.path.robot
        if "grip" not in legs:  # the hand holds it already, since a move that was cut short
            self._carrying = True
            return
        for leg in ("approach", "descend"):
            self.twin.grip(robot, legs[leg].opening)
            yield from self._follow(legs[leg])
        if self.sight and not self.sight.refer(robot, self.component, self.stands):
            yield from self._lose(
                "unseen", f"no camera sees {self.component} in the hand of {robot}: it was left there"
            )
        self.twin.grip(robot)
        yield from executing(self.twin, robot, "grip", legs["grip"].seconds)
        if not self._holds():
            wide = self.twin.opening(robot)
            text = f"{robot} missed {self.component}: its fingers closed on nothing"
            if wide > self.grasp.width / 2:
                text = f"{robot} closed on something {wide:.0f} mm wide, {self.component} has {self.grasp.width:g} mm"
            yield from self._lose("missed-grasp", text)
        self._carrying = True

    def _follow(self, segment: Segment) -> Steps:
        """Drive the arm along a segment, and see all the time whether the part still is in the hand."""
        self.twin.drive(self.path.robot, segment.times, segment.joints)
        moving = segment.moving.seconds
        for wait in executing(self.twin, self.path.robot, segment.name, moving):
            yield wait
            yield from self._watch(segment.name)
        if segment.seconds > moving:
            yield from self._steady(segment.seconds - moving)

    def _steady(self, seconds: float, far: float = NEARLY) -> Steps:
        """Let the arm come to rest, and see whether the part still is in the hand."""
        yield from steady(self.twin, self.path.robot, seconds, far)
        yield from self._watch()

    def _watch(self, phase: str = "transit") -> Steps:
        if self._carrying and not self._holds():
            text = f"{self.path.robot} dropped {self.component} on the {phase}: it slid out of the fingers"
            yield from self._lose("dropped", text)

    def _holds(self) -> bool:
        """Whether the pads are as far apart as the part is wide."""
        return self.grasp.fits(self.twin.opening(self.path.robot))

    def _meant(self, legs: dict[SegmentName, Segment]) -> _Held:
        """The part in the hand as the path means it: over the goal where the path ends, on the table where it grips."""
        base = -tool_pose(self.robot, legs["lower"].joints[-1])[2]
        return _Held(self._tool(legs["release"].joints[-1]).inverse().compose(self.goal), base)

    def _start(self, legs: dict[SegmentName, Segment]) -> Pose:
        """Where the path means the part to stand before it is picked."""
        return self._tool(legs["grip"].joints[-1]).compose(self._meant(legs).pose)

    def _look(self, legs: dict[SegmentName, Segment]) -> Generator[float, None, _Held]:
        """Return where the part is in the hand."""
        meant, robot = self._meant(legs), self.path.robot
        if self.sight is None:
            return meant
        seen = self.sight.pose_in_hand(robot, self.component)
        if seen is None and "grip" not in legs:  # there is nowhere better to put it
            return meant
        if seen is None:
            yield from self._return(legs, meant, "unseen", f"no camera sees {self.component} in the hand of {robot}")
        assert seen is not None  # `_lose` raises
        joints = self.twin.read(robot)
        held = _Held(self._tool(joints).inverse().compose(seen.pose), seen.height - tool_pose(self.robot, joints)[2])
        slid, turned = held.pose.distance(meant.pose), abs(angle_between(meant.pose.yaw, held.pose.yaw))
        if max(slid / SLID_MM, turned / SLID_DEG) > 1 and "grip" in legs:
            text = f"{self.component} slipped by {slid:.1f} mm and {turned:.1f}° in the fingers of {robot}"
            yield from self._return(legs, held, "slipped", text)
        return held

    def _aim(self, held: _Held, goal: Pose) -> Generator[float, None, Column]:
        """Bring the part in the hand over `goal`; return the vertical on which the hand is then."""
        column, z = self._over(held, goal), tool_pose(self.robot, self.twin.read(self.path.robot))[2]
        yield from nudge(self.twin, self.path.robot, _required(column.at(z)))
        yield from settle(self.twin, self.path.robot)
        yield from self._watch()
        return column

    def _over(self, held: _Held, goal: Pose) -> Column:
        """The vertical on which the hand has the part over `goal`."""
        joints = self.twin.read(self.path.robot)
        return self._column(goal.compose(held.pose.inverse()), tool_pose(self.robot, joints)[2], joints)

    def _put_down(self, column: Column, held: _Held) -> Steps:
        """Lower the part the last little way, and wait until the arm rests."""
        goal = column.at(CLEARANCE - held.base)
        yield from nudge(self.twin, self.path.robot, goal or self.twin.read(self.path.robot))
        yield from self._steady(BRIEFLY, FAR)

    def _let_go(self, release: Segment) -> Steps:
        self._carrying = False
        self.twin.grip(self.path.robot, release.opening)
        yield from executing(self.twin, self.path.robot, "release", release.seconds)
        if self.seated:
            self.seated(self.component)

    def _return(self, legs: dict[SegmentName, Segment], held: _Held, code: str, text: str) -> Steps:
        """Put the part back where it stood, the way it came, by where it is in the hand; raises Lost."""
        robot, top = self.path.robot, legs["transit"].joints[-1]
        yield from self._rise(tool_pose(self.robot, top)[2])
        yield from nudge(self.twin, robot, top)
        yield from settle(self.twin, robot)
        yield from self._follow(backward(legs["transit"].moving))
        yield from settle(self.twin, robot)
        column = yield from self._aim(held, self._start(legs))
        yield from self._follow(self._shifted(backward(legs["lift"]), column, CLEARANCE - held.base))
        yield from settle(self.twin, robot)
        yield from self._let_go(legs["release"])
        yield from self._lose(code, f"{text}: it was put back")

    def _tool(self, joints: Joints) -> Pose:
        x, y, _, yaw = tool_pose(self.robot, joints)
        return Pose(x, y, yaw)

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

    def _shifted(self, segment: Segment, column: Column, end: float | None) -> Segment:
        """The vertical `segment` on another column; its last height becomes `end` [mm] where that is given."""
        heights = [tool_pose(self.robot, joints)[2] for joints in segment.joints]
        if end is None:
            start, end = tool_pose(self.robot, self.twin.read(self.path.robot))[2], heights[-1]
        else:
            start = heights[0]
        scale = (end - start) / (heights[-1] - heights[0])
        moved = [column.at(start + scale * (z - heights[0])) for z in heights]
        joints = tuple(new or old for new, old in zip(moved, segment.joints, strict=True))
        times = tuple(t * max(1.0, scale) for t in segment.times)
        return Segment(segment.name, times, joints, segment.opening)

    def _lose(self, code: str, text: str) -> Steps:
        """Open the hand, bring it up, and raise Lost."""
        self._carrying = False
        self.twin.hold(self.path.robot)
        self.twin.grip(self.path.robot, self.path.segments[-1].opening)
        yield from passing(REST)
        yield from self._rise(self.robot.transit_height)
        raise Lost(error(code, text, address=self.component))

    def _rise(self, top: float) -> Steps:
        """Bring the hand straight up to `top` [mm]."""
        joints = self.twin.read(self.path.robot)
        x, y, z, yaw = tool_pose(self.robot, joints)
        if z > top - 1.0:
            return
        column = self._column(Pose(x, y, yaw), z, joints)
        way = [joints] + [column.at(z + (top - z) * i / 40) or joints for i in range(1, 41)]
        times = tuple(0.05 * i for i in range(41))
        yield from walk(self.twin, self.path.robot, (Segment("retreat", times, tuple(way), self.robot.gripper.stroke),))


def _blended(planned: Segment, wanted: Segment) -> Segment:
    """Return a segment that goes over from one to another one, which is near, in its first half."""
    count = len(planned.joints) - 1
    shares = [min(1.0, 2 * i / count) for i in range(count + 1)]
    soft = [s * s * (3 - 2 * s) for s in shares]
    joints = tuple(
        tuple(p + s * (w - p) for p, w in zip(a, b, strict=True))
        for s, a, b in zip(soft, planned.joints, wanted.joints, strict=True)
    )
    return Segment(wanted.name, wanted.times, joints, wanted.opening)


def _required(joints: Joints | None) -> Joints:
    assert joints is not None  # `_column` looked
    return joints
