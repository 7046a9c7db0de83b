"""Decides by looking at everything whether a small table can be rearranged at all: the planner's rules, its own code.

A component is where it was seen, at its goal, or in a storage slot at the slot's yaw or turned by quarters. Any move
between these is allowed that the independent checker finds nothing wrong with.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from functools import cache
from itertools import combinations

from checker import World
from random_labs import Case

from pico.model.observation import Observation
from pico.model.pose import Pose, wrap
from pico.model.setup import Setup
from pico.model.state import LabState, place_of

Spot = tuple[Pose, str | None]
Places = tuple[int, ...]


class Undecided(Exception):
    """More configurations than were to be looked at."""


class Puzzle:
    """The components of a small table, their spots, and which moves exclude which neighbours."""

    def __init__(self, setup: Setup, seen: Observation, wanted: LabState) -> None:
        self.setup, self.seen, self.wanted = setup, seen, wanted
        self.names = sorted(setup.lab.inventory)
        self.spots: list[list[Spot]] = []
        self.goals: list[set[int]] = []
        self.fixed = [not setup.movable(n) for n in self.names]
        for name in self.names:
            spots, goals = self._spots(name, wanted)
            self.spots.append(spots)
            self.goals.append(goals)
        self.clear = cache(self._clear)
        self.grip = cache(self._grip)
        self.stands = cache(self._stands)

    def _spots(self, name: str, wanted: LabState) -> tuple[list[Spot], set[int]]:
        pose = self.seen.components[name].pose
        assert pose is not None
        slot, goal = place_of(self.setup, wanted, name)
        movable = self.setup.movable(name)
        spots: list[Spot] = [(pose, None)]
        storage = self.setup.lab.slots[slot] if slot else None
        if storage and movable:
            right = storage.pose.distance(pose) <= storage.capture
            spots += [(Pose(goal.x, goal.y, wrap(goal.yaw + t)), slot) for t in (0, 90, 180, 270)]
        else:
            tolerance = self.setup.type_of(name).pose.tolerance
            turned = abs((pose.yaw - goal.yaw + 180) % 360 - 180)
            right = pose.distance(goal) <= tolerance.position and turned <= tolerance.yaw
            spots.append((goal, slot))
        goals = set(range(1, len(spots))) | ({0} if right else set())
        if movable and self.setup.lab.inventory[name].stage != "never":
            spots += [
                (Pose(s.x, s.y, wrap(s.yaw + t)), other)
                for other, s in sorted(self.setup.lab.slots.items()) if other != slot
                for t in (0, 90, 180, 270)
            ]  # fmt: skip
        return spots, goals

    def _alone(self, *placed: tuple[int, int]) -> World:
        """A table on which only these stand."""
        world = World(self.setup, self.seen, self.wanted)
        world.poses = {self.names[i]: self.spots[i][p][0] for i, p in placed}
        return world

    def _stands(self, i: int, p: int) -> bool:
        """Whether a component may stand at a spot of an empty table."""
        pose, slot = self.spots[i][p]
        world = self._alone((i, p))
        return not (p and world.place_faults(self.names[i], pose, slot))

    def _clear(self, i: int, p: int, j: int, q: int) -> bool:
        """Whether `i` may be put down at a spot beside `j` at one."""
        pose, slot = self.spots[i][p]
        return not self._alone((i, p), (j, q)).place_faults(self.names[i], pose, slot)

    def _grip(self, i: int, p: int, yaw: float, j: int, q: int) -> bool:
        """Whether the fingers have room around `i` beside `j`."""
        name = self.names[i]
        return not self._alone((i, p), (j, q)).grip_faults(name, self.spots[i][p][0], yaw, "arm1", "pick")

    def can(self, places: dict[int, int], i: int, p: int) -> bool:
        """Whether `i` can go to spot `p` while the others are where they are."""
        if not self.stands(i, p):
            return False
        others = [(j, q) for j, q in places.items() if j != i]
        if not all(self.clear(i, p, j, q) for j, q in others):
            return False
        if self.fixed[i]:
            return True
        grasp = self.setup.type_of(self.names[i]).geometry.grasp
        assert grasp is not None
        return any(all(self.grip(i, s, yaw, j, q) for s in (places[i], p) for j, q in others) for yaw in grasp.yaws)

    def moves(self, places: dict[int, int], who: tuple[int, ...]) -> Iterator[tuple[int, int]]:
        for i in who:
            if self.fixed[i] and places[i] in self.goals[i]:
                continue
            for p in range(1, len(self.spots[i])):
                if p != places[i] and self.can(places, i, p):
                    yield i, p

    def solvable(self, who: tuple[int, ...], limit: int) -> int | None:
        """Return the least number of moves that bring all of `who` home with only them on the table (besides what is
        fixed), or None; raises Undecided beyond `limit` configurations."""
        start = tuple(0 for _ in who)
        depth = {start: 0}
        queue = deque([start])
        while queue:
            state = queue.popleft()
            places = dict(zip(who, state, strict=True))
            if all(places[i] in self.goals[i] for i in who):
                return depth[state]
            for i, p in self.moves(places, who):
                after = tuple(p if j == i else q for j, q in zip(who, state, strict=True))
                if after not in depth:
                    depth[after] = depth[state] + 1
                    queue.append(after)
                    if len(depth) > limit:
                        raise Undecided
        return None


def least_moves(case: Case, *, limit: int = 200_000) -> int | None:
    """Return the least number of moves for a small case, None where there is no way; raises Undecided.

    Where a few components can't get home even without the others on the table, there is no way with them either, so
    small groups are tried first. What is fixed and right is on the table in each of them.
    """
    puzzle = Puzzle(case.setup, case.seen, case.wanted)
    everyone = tuple(range(len(puzzle.names)))
    always = [i for i in everyone if puzzle.fixed[i] and 0 in puzzle.goals[i]]
    rest = [i for i in everyone if i not in always]
    for size in (1, 2, 3):
        for group in combinations(rest, size):
            try:
                if puzzle.solvable((*always, *group), 20_000) is None:
                    return None
            except Undecided:
                continue
    return puzzle.solvable(everyone, limit)
