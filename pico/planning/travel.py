"""In which order an arm takes its moves: the least time of its empty hand, and how much less no order can take."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.model.observation import Observation
from pico.motion.types import Joints, Motion
from pico.planning.conflicts import Conflicts
from pico.planning.movers import Place
from pico.planning.order import Closure, arranged
from pico.planning.search import Step
from pico.planning.sequencing import Effort, best_order

SPEED = 300.0
"""What the hand travels at where no motion is asked for [mm/s]."""
TURN = 45.0
"""What it turns at [deg/s]."""
FAR = 1000.0
"""What stands for a way that the arm says it can't take by itself [s]; the paths have the last word."""
MANY = Effort(moves=150_000, steps=20_000_000, rounds=3)
"""How hard to look for an order of more moves than are solved exactly at once."""


@dataclass(frozen=True, slots=True)
class Tour:
    """Steps in order, and the least time in which the arms can take them in any order [s]; None where no arm told."""

    steps: tuple[Step, ...]
    bound: float | None = None


def toured(table: Conflicts, steps: Sequence[Step], closure: Closure, seen: Observation, motion: Motion | None) -> Tour:
    """Return the steps in the order that takes least time, as far as it is found. Where several robots or people take
    turns, each goes on as long as it can, to the nearest."""
    robots = {s.hold.robot for s in steps}
    clock = Clock(table, seen, motion)
    loaded = sum(clock.loaded(s) for s in steps) if clock.told else None
    if len(robots) > 1 or None in robots or len(steps) < 2:
        return Tour(arranged(table.setup, table, steps, closure), loaded)
    between = [[clock.between(a, b) if a is not b else 0.0 for b in steps] for a in steps]
    start, end = [clock.start(s) for s in steps], [clock.end(s) for s in steps]
    best = best_order(start, between, end, closure, limit=MANY)
    bound = None if loaded is None else loaded + best.lower_bound
    return Tour(tuple(steps[k] for k in best.order), bound)


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

    def loaded(self, step: Step) -> float:
        """Return the least time of a move from above its start until the hand is empty above its goal."""
        a, b = self._places(step)
        if self.motion is None or step.hold.robot is None:
            return 0.0
        name = self.table.movers[step.mover].name
        seconds = self.motion.carry(step.hold.robot, name, a.pose, b.pose, step.hold.yaw)
        return seconds if math.isfinite(seconds) else 0.0

    def start(self, step: Step) -> float:
        """Return the way from where the arm is to where a step begins."""
        robot = step.hold.robot or ""
        joints = self.seen.robots[robot].joints if robot in self.seen.robots else None
        place = self._places(step)[0]
        if self.told:
            return self._travel(robot, joints or None, place, 0.0, step.hold.yaw)
        mount = self.table.setup.lab.robots[robot].mount
        return math.hypot(place.pose.x - mount.x, place.pose.y - mount.y) / SPEED

    def between(self, first: Step, then: Step) -> float:
        """Return the way from where a step ends to where another begins."""
        a, b = self._places(first)[1], self._places(then)[0]
        if self.told:
            return self._travel(first.hold.robot or "", a, b, first.hold.yaw, then.hold.yaw)
        turned = abs(math.remainder(a.pose.yaw + first.hold.yaw - b.pose.yaw - then.hold.yaw, 180.0))
        return max(a.pose.distance(b.pose) / SPEED, turned / TURN)

    def end(self, step: Step) -> float:
        """Return the way from where a step ends to the park pose."""
        place = self._places(step)[1]
        if self.told:
            return self._travel(step.hold.robot or "", place, None, step.hold.yaw, 0.0)
        mount = self.table.setup.lab.robots[step.hold.robot or ""].mount
        return math.hypot(place.pose.x - mount.x, place.pose.y - mount.y) / SPEED

    def _places(self, step: Step) -> tuple[Place, Place]:
        places = self.table.movers[step.mover].places
        return places[step.start], places[step.goal]

    def _travel(
        self, robot: str, a: Place | Joints | None, b: Place | None, start_yaw: float, goal_yaw: float
    ) -> float:
        assert self.motion is not None
        begin = a.pose if isinstance(a, Place) else a
        seconds = self.motion.travel(robot, begin, b.pose if b else None, start_yaw, goal_yaw)
        return seconds if math.isfinite(seconds) else FAR
