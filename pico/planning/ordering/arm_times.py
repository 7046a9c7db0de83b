"""Several arms at work: how long they take for an order of moves, and in which order they are done soonest.

Numbers only. Arms meet in zones, where one at a time may be: who comes into a zone holds it for the whole move, and as
long as it stands there; it parks where another must come in before its own next move.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations

TRIED = 3000
"""How many moves the search for an order times in all, for each move; a count of work, so that the answer is always the
same."""
FEW = 5
"""Of up to so many moves all orders are timed."""
_EQUAL = 1e-6
_PARKED = -1
Table = tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class ArmWork:
    """The moves to be done by so many `arms`, all times in seconds, indices from 0.

    `arm[j]` makes move j: it comes from where it is at first (`start[j]`), from its park pose (`again[j]`), or from
    where move i of the same arm ends (`between[i][j]`); then takes `loaded[j]` until its hand is empty above the goal;
    and from there `end[j]` to its park pose. `before[j]`: the moves that j waits for. `enters[j]`: the zones in which
    it picks or places; `stays[j]`: those in which it then stands. `zones`: the arms that meet in each.
    """

    arms: int
    arm: tuple[int, ...]
    loaded: tuple[float, ...]
    start: tuple[float, ...]
    again: tuple[float, ...]
    between: Table
    end: tuple[float, ...]
    before: tuple[frozenset[int], ...]
    enters: tuple[frozenset[int], ...]
    stays: tuple[frozenset[int], ...]
    zones: tuple[tuple[int, int], ...]

    def of(self, arm: int) -> tuple[int, ...]:
        """Return the moves of one arm."""
        return tuple(j for j, a in enumerate(self.arm) if a == arm)

    def arrival(self, j: int) -> float:
        """Return the least time in which the arm comes to where move j begins."""
        return min(self.start[j], self.again[j], *(self.between[i][j] for i in self.of(self.arm[j]) if i != j))


def timed(work: ArmWork, order: Sequence[int]) -> tuple[float, float]:
    """Return when all is done and the arms are parked [s], and the sum of when each move is done [s].

    Each arm takes its moves in `order`, which keeps `before`; zones are entered in that order, too.
    """
    free, inside = [0.0] * work.arms, [frozenset[int]()] * work.arms
    last: list[int | None] = [None] * work.arms
    left: dict[tuple[int, int], float] = {}
    ends = [0.0] * len(work.arm)
    for j in order:
        a, before = work.arm[j], last[work.arm[j]]
        way = work.start[j] if before is None else work.again[j] if before < 0 else work.between[before][j]
        held = work.enters[j] | inside[a]
        begin = max(free[a], *(ends[e] for e in work.before[j])) if work.before[j] else free[a]
        for z in held:
            other = work.zones[z][0] if work.zones[z][1] == a else work.zones[z][1]
            if z in inside[other]:
                free[other] += work.end[last[other] or 0]
                left |= dict.fromkeys(((y, other) for y in inside[other]), free[other])
                inside[other], last[other] = frozenset(), _PARKED
            begin = max(begin, left.get((z, other), 0.0))
        free[a] = ends[j] = begin + way + work.loaded[j]
        for z in held:
            left[z, a] = ends[j]
        inside[a], last[a] = work.stays[j], j
    over = [t + (work.end[k] if k is not None and k >= 0 else 0.0) for t, k in zip(free, last, strict=True)]
    return max(over, default=0.0), sum(ends)


def soonest(work: ArmWork, order: Sequence[int], tried: int = TRIED, seed: int = 0) -> tuple[int, ...]:
    """Return an order that keeps `before` and ends as soon as one that is found from `order`, which keeps it as well:
    local search that shifts single moves, from there and again and again from some moves shifted at random. Of few
    moves all orders are timed first, and the search ends where none is better."""
    rnd, left, known = random.Random(seed), [tried * len(order)], dict[tuple[int, ...], tuple[float, float]]()
    best, cost = _descended(work, tuple(order), left, known)
    movable = left[0] < tried * len(order)  # no shift costs no work: where all moves wait in a row there is none
    if few := 2 < len(order) <= FEW:
        known |= {kept: timed(work, kept) for kept in permutations(order) if kept not in known and _keeps(work, kept)}
    while movable and left[0] > 0 and len(order) > 2:
        if few and not any(_less(value, cost) for value in known.values()):
            break
        kicked = best
        for _ in range(3):
            shifts = list(_shifts(work, kicked, rnd.randrange(len(kicked))))
            kicked = rnd.choice(shifts) if shifts else kicked
        found, value = _descended(work, kicked, left, known)
        if _less(value, cost):
            best, cost = found, value
    return best


def _keeps(work: ArmWork, order: tuple[int, ...]) -> bool:
    """Whether each move comes after those that it waits for."""
    return all(work.before[j].isdisjoint(order[n:]) for n, j in enumerate(order))


def _descended(
    work: ArmWork, order: tuple[int, ...], left: list[int], known: dict[tuple[int, ...], tuple[float, float]]
) -> tuple[tuple[int, ...], tuple[float, float]]:
    """Return the order after all shifts that make it better, and its times; `left`: moves that may still be timed;
    `known`: the times of orders, so that of few moves, whose orders come back, each is timed once."""
    cost, k, since = timed(work, order), 0, 0
    while since < len(order) and left[0] > 0:
        for shifted in _shifts(work, order, k % len(order)):
            left[0] -= len(order)
            value = known.get(shifted) or known.setdefault(shifted, timed(work, shifted))
            if _less(value, cost):
                order, cost, since = shifted, value, -1
                break
        k, since = k + 1, since + 1
    return order, cost


def _shifts(work: ArmWork, order: tuple[int, ...], k: int) -> Iterator[tuple[int, ...]]:
    """Yield the orders in which the k-th move comes earlier or later, as far as `before` allows."""
    j, rest = order[k], (*order[:k], *order[k + 1 :])
    for n in range(k - 1, -1, -1):
        if order[n] in work.before[j]:
            break
        yield (*rest[:n], j, *rest[n:])
    for n in range(k + 1, len(order)):
        if j in work.before[order[n]]:
            break
        yield (*rest[:n], j, *rest[n:])


def _less(a: tuple[float, float], b: tuple[float, float]) -> bool:
    return a[0] < b[0] - _EQUAL or (a[0] < b[0] + _EQUAL and a[1] < b[1] - _EQUAL)


def least(work: ArmWork, tours: Sequence[float], free: Mapping[int, float]) -> float:
    """Return a time before which no order and schedule of these moves ends [s], the arms parked; the longest of:

    what one arm needs for its moves (`tours`: a bound for each, travel included), what all arms need shared equally,
    what the moves in one zone need one after the other, and any chain of moves that wait for one another (the machine
    and path bounds of job-shop scheduling; Carlier and Pinson, 1989). Moves that are `free` may be made by another arm
    as well, in so many seconds at least; the way there then counts for nothing.
    """
    moves = range(len(work.arm))
    shortest = [free[j] if j in free else work.loaded[j] + work.arrival(j) for j in moves]
    tails = [0.0 if j in free else work.end[j] for j in moves]
    bounds = [*tours, sum(shortest) / work.arms]
    for z in range(len(work.zones)):
        inside = [j for j in moves if z in work.enters[j] and (work.arms == 2 or j not in free)]
        bounds.append(sum(shortest[j] for j in inside) + min((tails[j] for j in inside), default=0.0))
    chain: dict[int, float] = {}
    for j in sorted(moves, key=lambda j: len(work.before[j])):
        chain[j] = max((chain[e] + _handover(work, e, j, free) for e in work.before[j]), default=0.0) + shortest[j]
        bounds.append(chain[j] + tails[j])
    return max(bounds, default=0.0)


def _handover(work: ArmWork, first: int, then: int, free: Mapping[int, float]) -> float:
    """Return how long the arm of one move takes at least to leave the zones that another arm needs for a later one."""
    if first in free or then in free or work.arm[first] == work.arm[then] or not work.stays[first] & work.enters[then]:
        return 0.0
    onward = (work.between[first][k] + work.loaded[k] for k in work.of(work.arm[first]) if k != first)
    return min((work.end[first], *onward))
