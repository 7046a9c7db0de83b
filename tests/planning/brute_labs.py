"""The fewest stagings that bring a small lab to a state, by looking at every order, slot and grasp yaw.

Knows the model and the rules of the independent checker, nothing of the planner. A component is where it was seen, at
its goal, or in a slot at the slot's yaw or turned by quarters. It goes from one to another while the others are where
they are, if the checker would let it: its base, the slot's mouth, and the open fingers at both ends in one hold.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

from checker import EPSILON, Base, World, base, fingers, mouth, slot_used
from random_labs import Case

from pico.model.pose import Pose, wrap
from pico.model.state import place_of

AVOID = 2.0
"""What staging a part with `stage: avoid` costs beyond its move, in moves."""

Places = tuple[int, ...]


class Undecided(Exception):
    """More configurations than were to be looked at."""


@dataclass(frozen=True)
class Spot:
    """Where a component may stand."""

    pose: Pose
    slot: str | None
    base: Base


@dataclass(frozen=True)
class Best:
    """The cheapest way: how many moves, and what they cost where staging a part with `stage: avoid` costs more."""

    moves: int
    cost: float


class Lab:
    """The components of a small lab, their spots, and what each move needs empty, as bits of spots. `paths`: whether
    arms are asked for their paths."""

    paths = False

    def __init__(self, case: Case) -> None:
        self.case, self.setup, self.prices = case, case.setup, True
        self.names = sorted(case.setup.lab.inventory)
        self.by_arm = [case.setup.movable(n) for n in self.names]
        self.spots, self.goals = list[list[Spot]](), list[set[int]]()
        for name in self.names:
            spots, goals = self._spots(name)
            self.spots.append(spots)
            self.goals.append(goals)
        self._first = [sum(len(s) for s in self.spots[:i]) for i in range(len(self.names))]
        self._stand: dict[tuple[int, int], int | None] = {}
        self._holds: dict[tuple[int, int], list[int]] = {}

    def bit(self, i: int, p: int) -> int:
        return 1 << (self._first[i] + p)

    def right(self, i: int) -> bool:
        """Whether a component stands where it belongs."""
        return 0 in self.goals[i]

    def _spots(self, name: str) -> tuple[list[Spot], set[int]]:
        pose = self.case.seen.components[name].pose
        assert pose is not None
        footprint, lab = self.setup.type_of(name).geometry.footprint, self.setup.lab
        slot, goal = place_of(self.setup, self.case.wanted, name)
        movable = self.setup.movable(name)
        poses: list[tuple[Pose, str | None]] = [(pose, None)]
        if slot and movable:
            right = lab.slots[slot].pose.distance(pose) <= lab.slots[slot].capture
            poses += [(Pose(goal.x, goal.y, wrap(goal.yaw + t)), slot) for t in (0, 90, 180, 270)]
        else:
            tolerance = self.setup.type_of(name).pose.tolerance
            turned = abs((pose.yaw - goal.yaw + 180) % 360 - 180)
            right = pose.distance(goal) <= tolerance.position and turned <= tolerance.yaw
            poses.append((goal, slot))
        goals = set(range(1, len(poses))) | ({0} if right else set())
        if movable and lab.inventory[name].stage != "never":
            others = ((n, s) for n, s in sorted(lab.slots.items()) if n != slot)
            poses += [(Pose(s.x, s.y, wrap(s.yaw + t)), n) for n, s in others for t in (0, 90, 180, 270)]
        return [Spot(p, s, base(footprint, p)) for p, s in poses], goals

    def stand(self, i: int, p: int) -> int | None:
        """Return the spots of others that must be empty for a component to be put down at a spot; None: it never
        may."""
        if (i, p) not in self._stand:
            self._stand[i, p] = self._standing(i, p)
        return self._stand[i, p]

    def _standing(self, i: int, p: int) -> int | None:
        spot = self.spots[i][p]
        alone = World(self.setup, self.case.seen, self.case.wanted)
        alone.poses = {}
        return None if alone.place_faults(self.names[i], spot.pose, spot.slot) else self.around(i, p)

    def around(self, i: int, p: int) -> int:
        """Return `stand`, whether or not a component may stand there at all."""
        spot, lab = self.spots[i][p], self.setup.lab
        mask = self._near(i, spot.base, max(lab.margins.body - EPSILON, 0.0))
        if spot.slot:
            mask |= self._near(i, mouth(lab.slots[spot.slot]), 0.0)
        return mask | self._covered(i, p)

    def _covered(self, i: int, p: int) -> int:
        """Return the spots of others in slots that a component would cover at a spot: only where both belong it may."""
        mask, shape = 0, self.spots[i][p].base
        for j, spots in enumerate(self.spots):
            for q, s in enumerate(spots if j != i else ()):
                slot = slot_used(self.setup, self.names[j], s.pose)
                if slot and mouth(self.setup.lab.slots[slot]).gap(shape) <= 0.0:
                    mask |= 0 if p in self.goals[i] and q in self.goals[j] else self.bit(j, q)
        return mask

    def _near(self, i: int, shape: Base, enough: float, above: float = -1.0) -> int:
        """Return the spots of others, taller than `above`, with no more than `enough` to a shape."""
        mask = 0
        for j, spots in enumerate(self.spots):
            if j != i and self.setup.type_of(self.names[j]).geometry.height > above:
                mask |= sum(self.bit(j, q) for q, s in enumerate(spots) if shape.gap(s.base) <= enough)
        return mask

    def holds(self, i: int, p: int) -> list[int]:
        """Return for each grasp yaw the spots of others that must be empty for the open fingers; for a part that a
        person moves none, once."""
        if (i, p) not in self._holds:
            self._holds[i, p] = list(self._fingers(i, p))
        return self._holds[i, p]

    def rooms(self, i: int, p: int) -> list[int]:
        """Return `holds`, whether or not an arm gets there."""
        return self.holds(i, p)

    def _fingers(self, i: int, p: int) -> Iterator[int]:
        geometry, lab = self.setup.type_of(self.names[i]).geometry, self.setup.lab
        if not self.by_arm[i] or geometry.grasp is None:
            yield 0
            return
        enough = max(lab.margins.fingers - EPSILON, 0.0)
        for yaw in geometry.grasp.yaws:
            zones, lowest = fingers(geometry, lab.robots["arm1"].gripper, yaw, self.spots[i][p].pose)
            mask = 0
            for zone in zones:
                mask |= self._near(i, zone, enough, lowest)
            yield mask

    def goes(self, i: int, places: dict[int, int], p: int, hold: int, parks: bool) -> bool:
        """Whether an arm has a path for a component to a spot."""
        return True

    def moves(self, places: dict[int, int], who: tuple[int, ...]) -> Iterator[tuple[int, int]]:
        """Yield the moves that are possible now: a component, and the spot that it goes to."""
        taken = sum(self.bit(i, p) for i, p in places.items())
        for i in who:
            if not self.by_arm[i] and places[i] in self.goals[i]:
                continue
            now = self.holds(i, places[i])
            for p in range(1, len(self.spots[i])):
                body = self.stand(i, p) if p != places[i] else None
                if body is None or body & taken:
                    continue
                if any(not (a | b) & taken for a, b in zip(now, self.holds(i, p), strict=True)):
                    yield i, p

    def best(self, who: tuple[int, ...], still: tuple[int, ...], limit: int) -> Best | None:
        """Return the cheapest way to bring all of `who` home while `still` stay, with nobody else on the table; None
        where there is none. Raises Undecided beyond `limit` configurations."""
        start: Places = (0,) * len(who)
        costs = {start: 0.0}
        heap = [(self._left(who, start), 0.0, 0, start)]
        while heap:
            _, cost, count, state = heapq.heappop(heap)
            if cost > costs[state]:
                continue
            if not self._left(who, state):
                return Best(count, cost)
            places = dict(zip(who, state, strict=True)) | dict.fromkeys(still, 0)
            for i, p in self.moves(places, who):
                after = tuple(p if j == i else q for j, q in zip(who, state, strict=True))
                total = cost + self.price(i, p)
                if total < costs.get(after, float("inf")):
                    costs[after] = total
                    heapq.heappush(heap, (total + self._left(who, after), total, count + 1, after))
            if len(costs) > limit:
                raise Undecided
        return None

    def _left(self, who: tuple[int, ...], state: Places) -> int:
        return sum(p not in self.goals[i] for i, p in zip(who, state, strict=True))

    def price(self, i: int, p: int) -> float:
        """Return what a move costs, in moves; with `prices` a part that had better not be staged costs more."""
        avoided = self.prices and self.setup.lab.inventory[self.names[i]].stage == "avoid"
        return 1.0 + (AVOID if avoided and p not in self.goals[i] else 0.0)


def cheapest(lab: Lab, *, asides: bool, limit: int, prices: bool = True) -> Best | None:
    """Return the cheapest way, moving what is right only with `asides`, all parts alike without `prices`; None where
    there is none. Raises Undecided.

    Where a few components can't get home even without the others that move there is no way with them either, so small
    groups are tried first.
    """
    lab.prices = prices
    everyone = range(len(lab.names))
    still = tuple(i for i in everyone if lab.right(i) and not (asides and lab.by_arm[i]))
    who = tuple(i for i in everyone if i not in still)
    for size in (1, 2, 3):
        for group in combinations(who, size):
            try:
                if size < len(who) and lab.best(group, still, limit // 10) is None:
                    return None
            except Undecided:
                continue
    return lab.best(who, still, limit)
