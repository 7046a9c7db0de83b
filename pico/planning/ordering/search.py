"""Best-first search for an order of moves, staging where it must; knows spots and masks, nothing of a table.

f = cost so far + weight * components that are not where they should be. The work is limited by the number of
configurations expanded, never by time, so that the same problem always has the same answer.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from pico.planning.ordering.conflicts import Conflicts, Way
from pico.planning.parts.movers import Hold

Configuration = tuple[int, ...]
"""The place of each mover, by index."""


@dataclass(frozen=True, slots=True)
class OrderedMove:
    """One move of the answer; `mask`: the bits of the spots that must be empty."""

    mover: int
    start: int
    goal: int
    hold: Hold
    mask: int


@dataclass(frozen=True, slots=True)
class SearchEffort:
    """How hard to search. `commit`: make a move at once that hinders nobody's direct move. `slots`: how many storage
    places to try for each component (None: all). `everyone`: stage any component, not only those in the way; `only`:
    stage none but these (None: all)."""

    weight: float
    limit: int
    commit: bool = False
    slots: int | None = None
    everyone: bool = False
    only: frozenset[int] | None = None


@dataclass(frozen=True, slots=True)
class Found:
    """What a search came to: the steps, or None and whether every configuration was seen (`exhausted`); `closest` is
    the configuration with the fewest components out of place."""

    steps: tuple[OrderedMove, ...] | None
    exhausted: bool
    closest: Configuration
    expanded: int


@dataclass(slots=True)
class Expansions:
    """A limit on expansions that several searches share."""

    left: int


@dataclass(slots=True)
class _Search:
    table: Conflicts
    who: tuple[int, ...]
    effort: SearchEffort
    finished: tuple[frozenset[int], ...]
    _storage: dict[int, tuple[int, ...]] = field(default_factory=dict)

    def occupied(self, places: Configuration) -> int:
        union = 0
        for i in self.who:
            union |= self.table.bit(i, places[i])
        return union

    def pending(self, places: Configuration) -> list[int]:
        return [i for i in self.who if places[i] not in self.finished[i]]

    def direct(self, i: int, places: Configuration, taken: int) -> Iterator[tuple[int, Way]]:
        """Yield the goals that a component can go to now."""
        for goal in self.table.movers[i].goals:
            if goal != places[i]:
                way = self.table.way(i, places[i], goal, taken)
                if way:
                    yield goal, way
                    if not self.effort.everyone:
                        return

    def moves(self, places: Configuration, taken: int) -> Iterator[tuple[OrderedMove, float]]:
        """Yield the moves from a configuration that are worth trying, with their costs."""
        pending, stuck = self.pending(places), []
        homing: list[OrderedMove] = []
        for i in pending:
            before = len(homing)
            homing += [OrderedMove(i, places[i], g, w.hold, w.mask) for g, w in self.direct(i, places, taken)]
            if len(homing) == before:
                stuck.append(i)
        if self.effort.commit:
            for step in homing:
                if self._harmless(step, pending, places):
                    yield step, 1.0
                    return
        yield from ((step, 1.0) for step in homing)
        for i in self.who if self.effort.everyone else self._in_the_way(stuck, pending, places, taken):
            if self.effort.only is None or i in self.effort.only:
                yield from self._stagings(i, places, taken)

    def _harmless(self, step: OrderedMove, pending: Sequence[int], places: Configuration) -> bool:
        """Whether a component at its goal hinders no direct move of those still to go."""
        bit = self.table.bit(step.mover, step.goal)
        return not any(
            way.mask & bit
            for j in pending if j != step.mover
            for goal in self.table.movers[j].goals
            for way in self.table.ways(j, places[j], goal)
        )  # fmt: skip

    def _in_the_way(self, stuck: list[int], pending: list[int], places: Configuration, taken: int) -> list[int]:
        """Return the components that can't go where they should, those that hinder somebody, and those that hinder
        these from being picked."""
        found: dict[int, None] = dict.fromkeys(stuck)
        for i in pending:
            found.update(dict.fromkeys(self._hindering(i, places, taken, self.table.movers[i].goals)))
        queue = list(found)
        while queue:
            i = queue.pop()
            for hold in self.table.movers[i].holds:
                for j, _ in self.table.at((self.table.grip(i, places[i], hold) or 0) & taken):
                    if j not in found:
                        found[j] = None
                        queue.append(j)
        return sorted(found)

    def _hindering(self, i: int, places: Configuration, taken: int, goals: Sequence[int]) -> Iterator[int]:
        for goal in goals:
            union = self._body(i, goal)
            for way in self.table.ways(i, places[i], goal):
                union |= way.mask
            for j, _ in self.table.at(union & taken & ~self.table.bit(i, places[i])):
                yield j

    def _stagings(self, i: int, places: Configuration, taken: int) -> Iterator[tuple[OrderedMove, float]]:
        mover, tried = self.table.movers[i], 0
        for place in self.storage(i):
            if place == places[i] or (not self.effort.everyone and self._same_slot(i, place, places[i])):
                continue
            way = self.table.way(i, places[i], place, taken)
            if way is None:
                continue
            yield OrderedMove(i, places[i], place, way.hold, way.mask), 1.0 + mover.penalty
            tried += 1
            if self.effort.slots is not None and tried >= self.effort.slots:
                return

    def _same_slot(self, i: int, a: int, b: int) -> bool:
        spots = self.table.movers[i].places
        return spots[a].slot is not None and spots[a].slot == spots[b].slot

    def storage(self, i: int) -> tuple[int, ...]:
        """Return the storage places of a component, those first that nobody needs and that hinder least, then near
        ones."""
        if i not in self._storage:
            self._storage[i] = ranked_storage(self.table, i, self.who)
        return self._storage[i]

    def _body(self, i: int, place: int) -> int:
        return self.table.arrive(i, place) or 0


def ranked_storage(table: Conflicts, i: int, who: Sequence[int]) -> tuple[int, ...]:
    """Return the storage places of a component, those first that none of `who` needs and that hinder least, then near
    ones."""
    mover = table.movers[i]
    wanted, inside = {table.movers[j].goal.slot for j in who}, table.by_slot()

    def rank(place: int) -> tuple[bool, int, float]:
        spot = mover.places[place]
        crowd = ((table.arrive(i, place) or 0) & ~inside[spot.slot]).bit_count()
        return spot.slot in wanted, crowd, spot.pose.distance(mover.goal.pose)

    return tuple(sorted((p for p in mover.staging if table.arrive(i, p) is not None), key=rank))


def search(
    table: Conflicts, effort: SearchEffort, who: Sequence[int] | None = None, work: Expansions | None = None
) -> Found:
    """Return the steps that bring the movers `who` (all where None; the others are left out of the world) to their
    goals, or None. `work` takes the place of the effort's own limit."""
    names = tuple(range(len(table.movers))) if who is None else tuple(who)
    searched = _Search(table, names, effort, tuple(m.finished for m in table.movers))
    work = work or Expansions(effort.limit)
    start: Configuration = (0,) * len(table.movers)
    closest, fewest = start, len(searched.pending(start))
    costs: dict[Configuration, float] = {start: 0.0}
    parents: dict[Configuration, tuple[Configuration, OrderedMove]] = {}
    heap: list[tuple[float, int, int, Configuration, float]] = [(0.0, fewest, 0, start, 0.0)]
    expanded = pushed = 0
    while heap:
        _, left, _, places, cost = heapq.heappop(heap)
        if cost > costs[places]:
            continue
        if left < fewest:
            closest, fewest = places, left
        if left == 0:
            return Found(_trace(parents, places), False, closest, expanded)
        if work.left <= 0:
            return Found(None, False, closest, expanded)
        work.left -= 1
        expanded += 1
        taken = searched.occupied(places)
        for step, price in searched.moves(places, taken):
            after = (*places[: step.mover], step.goal, *places[step.mover + 1 :])
            total = cost + price
            if total >= costs.get(after, float("inf")):
                continue
            costs[after], parents[after] = total, (places, step)
            pushed += 1
            done = searched.finished[step.mover]
            remaining = left - (step.goal in done) + (step.start in done)
            heapq.heappush(heap, (total + effort.weight * remaining, remaining, pushed, after, total))
    return Found(None, True, closest, expanded)


def _trace(
    parents: dict[Configuration, tuple[Configuration, OrderedMove]], places: Configuration
) -> tuple[OrderedMove, ...]:
    steps = []
    while places in parents:
        places, step = parents[places]
        steps.append(step)
    return tuple(reversed(steps))
