"""The ways of an arm that uses a tool: it takes it where it stands, lowers it over one place after the other, turns it
there, and puts it back. Legs between places are gone at transit height, and all of them are checked as those of a move.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from pico.motion import timing
from pico.motion.explain import blocked
from pico.motion.kinematics import Column
from pico.motion.moves import DETOUR_TRIES, Move, Postures, ascend, legs
from pico.motion.paths import Stand, distance, plumb, postures, stand, swing, usable
from pico.motion.scene import Hit
from pico.motion.types import Blocked, Joints, MovePath, Segment, Waypoint
from pico.motion.xarm7 import LIMITS

Ways = tuple[MovePath, ...]
"""Taking the tool, using it, putting it back: each ends where the next one begins."""


@dataclass
class Using(Move):
    """The ways of an arm with a tool: `start` is `goal`, where it stands."""

    points: Sequence[Waypoint] = ()

    def ways(self) -> Ways | Blocked:
        """Return the first clear ways, those that go least far first; else why the best fail."""
        self._enter("approach")
        rise = ascend(self.scene, self.joints, self.standing)
        if isinstance(rise, Hit):
            return blocked(self.errand, "approach", rise)
        above = stand(self.scene, rise[-1])
        reason: Blocked | None = None
        for column, top in self._picks(above)[:DETOUR_TRIES]:
            choice = Postures(column, column)
            found = self._attempt(above, choice, detours=True)
            used = found if isinstance(found, Blocked) else self._used(Stand(top, column))
            if isinstance(found, Blocked) or isinstance(used, Blocked):
                reason = reason or (found if isinstance(found, Blocked) else used)  # type: ignore[assignment]
                continue
            whole = self._timed(rise, *found, choice)
            return self._three(whole, used)
        return reason or Blocked("reach", f"{self.scene.name} can't take {self.component} at {self.start}")

    def _picks(self, above: Stand) -> list[tuple[Column, Joints]]:
        found = [
            one
            for half in (0.0, 180.0)
            for one in postures(self.scene.robot, self.start, self.grasp_yaw + half, self.low)
        ]
        return sorted(found, key=lambda one: (round(distance(above.joints, one[1]), 9), one[1]))

    def _used(self, pick: Stand) -> list[Segment] | Blocked:
        """The legs with the tool in hand, from above where it stands to there."""
        segments, here = list[Segment](), pick
        for point in self.points:
            found = self._over(here, point, pick)
            if isinstance(found, Blocked):
                return found
            segments += found[0]
            here = found[1]
        home = self._way("transit", here, pick, detours=True)
        if isinstance(home, Hit):
            return blocked(self.errand, "transit", home)
        return [*segments, Segment("transit", *timing.steady(legs(self.scene, home, 0)), self.width)]

    def _over(self, here: Stand, point: Waypoint, pick: Stand) -> tuple[list[Segment], Stand] | Blocked:
        """The legs over one place, down, around and up again, and where the arm then is."""
        low = self.low + point.height
        if low > self.high - 1.0:
            return Blocked("height", f"{self.component} would be held higher than the arm goes: {point.height:g} mm")
        reason: Blocked | None = None
        for column, top in self._columns(here, point, pick, low)[:DETOUR_TRIES]:
            after = _turned(column, point.turn)
            bottom, around = _at(column, low), _at(after, low)
            way = self._way("transit", here, Stand(top, column), detours=True)
            self._enter("transit")
            hit = way if isinstance(way, Hit) else plumb(self.scene, column, low, self.high)
            hit = hit or (swing(self.scene, bottom, around) if point.turn else None)
            hit = hit or plumb(self.scene, after, low, self.high)
            if hit is not None or isinstance(way, Hit):
                reason = reason or blocked(self.errand, "lower", hit or way)  # type: ignore[arg-type]
                continue
            robot, width = self.scene.robot, self.width
            down = timing.steady(timing.vertical(robot, column, self.high, low), timing.CORRECTING)
            found = [
                Segment("transit", *timing.steady(legs(self.scene, way, 0)), width),
                Segment("lower", *down, width),
            ]
            if point.turn:
                found.append(Segment("transit", *timing.steady(legs(self.scene, [bottom, around], 0)), width))
            found.append(Segment("lift", *timing.vertical(robot, after, low, self.high), width))
            return found, Stand(_at(after, self.high), after)
        text = (
            f"{self.scene.name} can't bring {self.component} over {point.pose} and turn it there by {point.turn:g} deg"
        )
        return reason or Blocked("reach", text)

    def _columns(self, here: Stand, point: Waypoint, pick: Stand, low: float) -> list[tuple[Column, Joints]]:
        """The postures over a place, by how far the joints go; the tool is held as it was taken."""
        assert pick.column is not None  # `postures` gave it
        hand = math.degrees(pick.column.q1 - pick.column.q7) - self.start.yaw
        found = []
        for half in (0.0, 180.0):
            for column, top in postures(self.scene.robot, point.pose, self.grasp_yaw + half, low):
                off = math.degrees(column.q1 - column.q7) - point.pose.yaw - hand
                after = _turned(column, point.turn)
                if abs((off + 180) % 360 - 180) < 1.0 and _within(after) and usable(after, low, self.high):
                    found.append((column, top))
        return sorted(found, key=lambda one: (round(distance(here.joints, one[1]), 9), one[1]))

    def _three(self, whole: MovePath, used: list[Segment]) -> Ways:
        """Taking, using and putting back; the last lift begins the third, and nothing opens in the second."""
        take, down = whole.segments[:4], whole.segments[5:]
        last = max((n for n, leg in enumerate(used) if leg.name == "lift"), default=len(used) - 1)
        middle = tuple(replace(leg, opening=0.0) for leg in used[:last])
        parts = (take, middle, (*used[last:], *down))
        return tuple(MovePath(self.scene.name, self.component, part) for part in parts if part)


def _turned(column: Column, turn: float) -> Column:
    """Return the posture after the tool was turned there [deg]."""
    return replace(column, q7=column.q7 - math.radians(turn))


def _within(column: Column) -> bool:
    return LIMITS[6][0] <= column.q7 <= LIMITS[6][1]


def _at(column: Column, z: float) -> Joints:
    joints = column.at(z)
    assert joints is not None  # `usable` looked
    return joints
