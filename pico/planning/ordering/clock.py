"""How long a hand takes from place to place, as the arm says or by distance: what orders of moves are compared by."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.model.observation import Observation
from pico.motion.types import Joints, Motion
from pico.planning.ordering.conflicts import Conflicts
from pico.planning.ordering.search import OrderedMove
from pico.planning.parts.movers import Place

SPEED = 300.0
"""What the hand travels at where no motion is asked for [mm/s]."""
TURN = 45.0
"""What it turns at [deg/s]."""
HANDLING = 6.0
"""What picking and placing takes besides [s]."""
FAR = 1000.0
"""What stands for a way that the arm says it can't take by itself [s]; the paths have the last word."""


@dataclass(frozen=True, slots=True)
class Clock:
    """How long the hand takes from place to place [s]: as the arm says, or by distance."""

    table: Conflicts
    seen: Observation
    motion: Motion | None

    @property
    def told(self) -> bool:
        """Whether the arm says how long it takes."""
        return hasattr(self.motion, "travel") and hasattr(self.motion, "carry")

    def loaded(self, step: OrderedMove) -> float:
        """Return the least time of a move from above its start until the hand is empty above its goal."""
        a, b = self._places(step)
        if step.hold.robot is None:
            return 0.0
        if self.motion is None or not self.told:
            return HANDLING + a.pose.distance(b.pose) / SPEED
        name = self.table.movers[step.mover].name
        seconds = self.motion.carry(step.hold.robot, name, a.pose, b.pose, step.hold.yaw)
        return seconds if math.isfinite(seconds) else 0.0

    def start(self, step: OrderedMove) -> float:
        """Return the way from where the arm is to where a step begins."""
        robot = step.hold.robot or ""
        joints = self.seen.robots[robot].joints if robot in self.seen.robots else None
        place = self._places(step)[0]
        if self.told:
            return self._travel(robot, joints or None, place, 0.0, step.hold.yaw)
        mount = self.table.setup.lab.robots[robot].mount
        return math.hypot(place.pose.x - mount.x, place.pose.y - mount.y) / SPEED

    def again(self, step: OrderedMove) -> float:
        """Return the way from the park pose to where a step begins."""
        return self._travel(step.hold.robot or "", None, self._places(step)[0], 0.0, step.hold.yaw)

    def between(self, first: OrderedMove, then: OrderedMove) -> float:
        """Return the way from where a step ends to where another begins."""
        a, b = self._places(first)[1], self._places(then)[0]
        if self.told:
            return self._travel(first.hold.robot or "", a, b, first.hold.yaw, then.hold.yaw)
        turned = abs(math.remainder(a.pose.yaw + first.hold.yaw - b.pose.yaw - then.hold.yaw, 180.0))
        return max(a.pose.distance(b.pose) / SPEED, turned / TURN)

    def end(self, step: OrderedMove) -> float:
        """Return the way from where a step ends to the park pose."""
        place = self._places(step)[1]
        if self.told:
            return self._travel(step.hold.robot or "", place, None, step.hold.yaw, 0.0)
        mount = self.table.setup.lab.robots[step.hold.robot or ""].mount
        return math.hypot(place.pose.x - mount.x, place.pose.y - mount.y) / SPEED

    def around(self, steps: Sequence[OrderedMove], k: int) -> float:
        """Return what step `k` costs with the ways to it and from it."""
        way = self.start(steps[k]) if k == 0 else self.between(steps[k - 1], steps[k])
        on = self.end(steps[k]) if k + 1 == len(steps) else self.between(steps[k], steps[k + 1])
        return way + self.loaded(steps[k]) + on

    def _places(self, step: OrderedMove) -> tuple[Place, Place]:
        places = self.table.movers[step.mover].places
        return places[step.start], places[step.goal]

    def _travel(
        self, robot: str, a: Place | Joints | None, b: Place | None, start_yaw: float, goal_yaw: float
    ) -> float:
        assert self.motion is not None
        begin = a.pose if isinstance(a, Place) else a
        seconds = self.motion.travel(robot, begin, b.pose if b else None, start_yaw, goal_yaw)
        return seconds if math.isfinite(seconds) else FAR
