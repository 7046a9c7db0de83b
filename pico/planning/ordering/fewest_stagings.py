"""The order of moves with the fewest stagings that storage has room for: search harder only where it must."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from pico.planning.ordering.conflicts import FEW, Conflicts, sum_of
from pico.planning.ordering.realize import realized, slots_needed
from pico.planning.ordering.relaxed import relaxation, staging_cost
from pico.planning.ordering.search import Configuration, Found, OrderedMove, SearchEffort, search
from pico.staging.feedback import Limit, StagingAnswer
from pico.staging.feedback import solve as fewest_staged

COMPLETE = FEW
"""Up to so many movers nothing solvable is refused: the last search prunes nothing."""

BOUND = Limit(solves=60, nodes=5000)
"""How hard to look for the fewest stagings that would do if storage had room for all."""
OTHERS = 4
"""How many other sets of components to stage are tried where storage has no room for the first."""
EFFORTS = (
    SearchEffort(weight=1.0, limit=300, commit=True, slots=3),
    SearchEffort(weight=2.0, limit=600, commit=True, slots=3),
    SearchEffort(weight=3.0, limit=1500, slots=6),
)
EVERYTHING = SearchEffort(weight=2.0, limit=200_000, everyone=True)
FEWEST = SearchEffort(weight=1.0, limit=4000, everyone=True)
PROOF = SearchEffort(weight=2.0, limit=3000, everyone=True)
PROOF_WORK = 30_000
"""Expansions spent in all on proving that a few movers are enough to make a problem impossible."""


@dataclass(frozen=True, slots=True)
class StagingSearch:
    """The moves, or None; `least`: stagings below which no order of these movers' moves goes. Without moves: `core`,
    movers that are proven not to get home together, if known, the configuration that came closest, and whether it is
    `proven` that there is no order. `slots`: where storage has no room for the fewest stagings, how many free slots
    would do; 0 where it has, or where that is not known. `others`: more answers, which may stage more."""

    steps: tuple[OrderedMove, ...] | None
    least: int = 0
    core: tuple[int, ...] = ()
    closest: Configuration = ()
    proven: bool = False
    slots: int = 0
    others: tuple[tuple[OrderedMove, ...], ...] = ()


def stagings(steps: Sequence[OrderedMove]) -> int:
    """Return how many moves put a component down on its way: those besides the last of each."""
    return len(steps) - len({s.mover for s in steps})


def search_fewest(table: Conflicts, *, several: bool = False) -> StagingSearch:
    """Return the moves with the fewest stagings that were found, and how few there must be; `several`: and what else a
    longer search finds."""
    for i, mover in enumerate(table.movers):
        if not mover.right and not any(table.ways(i, 0, g) for g in mover.goals):
            alone = search(table, PROOF, (i,))
            if alone.exhausted:
                return StagingSearch(None, 0, (i,), alone.closest, True)
    relaxed = fewest_staged(relaxation(table), BOUND)
    if relaxed.options is None and relaxed.proven:
        core = tuple(sorted({i for cycle in relaxed.cycles for link in cycle for i in (link[0], link[2])}))
        return StagingSearch(None, 0, core, (0,) * len(table.movers), True)
    least = _least(table, relaxed)
    answers = _with_room(table, relaxed)
    for steps in answers:
        return StagingSearch(steps, least, others=tuple(_others(table, answers)) if several else ())
    slots = slots_needed(relaxation(table), relaxed) if relaxed.options is not None else 0
    found = _searched(table)
    if found.steps is not None:
        return _compared(table, found.steps, least, slots)
    core = _core(table, found.closest)
    if not core and len(table.movers) <= COMPLETE:
        found = search(table, EVERYTHING)
    return StagingSearch(found.steps, least, core, found.closest, bool(core) or found.exhausted, slots)


def _least(table: Conflicts, relaxed: StagingAnswer) -> int:
    """Return the fewest stagings, whatever they cost."""
    if relaxed.count and any(staging_cost(m) > 1 for m in table.movers):
        relaxed = fewest_staged(relaxation(table, (1.0,) * len(table.movers)), BOUND)
    return math.ceil(relaxed.lower_bound - 1e-6) if math.isfinite(relaxed.lower_bound) else 0


def _with_room(table: Conflicts, relaxed: StagingAnswer) -> Iterator[tuple[OrderedMove, ...]]:
    """Yield moves that stage no more than the relaxed answer, with a slot for each."""
    costs = [staging_cost(m) for m in table.movers]
    weights, answer = list(costs), relaxed
    for _ in range(1 + OTHERS):
        if answer.options is None or sum(costs[i] for i in answer.staged) > relaxed.weight + 1e-6:
            return
        problem = relaxation(table, tuple(weights))
        if steps := realized(table, problem, answer):
            yield steps
        only = SearchEffort(weight=2.0, limit=200, commit=True, slots=6, only=frozenset(answer.staged))
        if found := search(table, only).steps:
            yield found
        for i in answer.staged:
            weights[i] += costs[i] / (2 * len(costs))
        answer = fewest_staged(relaxation(table, tuple(weights)), BOUND)


def _others(table: Conflicts, answers: Iterator[tuple[OrderedMove, ...]]) -> Iterator[tuple[OrderedMove, ...]]:
    yield from answers
    for effort in EFFORTS[:2]:
        if found := search(table, effort).steps:
            yield found


def _searched(table: Conflicts) -> Found:
    for effort in EFFORTS:
        found = search(table, effort)
        if found.steps is not None:
            break
    return found


def _compared(table: Conflicts, steps: tuple[OrderedMove, ...], least: int, slots: int) -> StagingSearch:
    """Return the moves, or fewer where a complete search of a small table finds them, which proves their number."""
    if stagings(steps) == least:
        return StagingSearch(steps, least)
    if len(table.movers) <= COMPLETE and not any(m.right or m.penalty for m in table.movers):
        found = search(table, FEWEST)
        if found.steps is not None:
            return StagingSearch(found.steps, stagings(found.steps), slots=slots)
    return StagingSearch(steps, least, slots=slots)


def _core(table: Conflicts, closest: Configuration) -> tuple[int, ...]:
    """Return two or three movers that can't get home even where all others are taken off the table. On a large table
    threes are looked for only among those that the search did not bring home."""
    who = [i for i, m in enumerate(table.movers) if not m.right]
    stuck = [i for i in who if closest[i] not in table.movers[i].finished]
    small, arcs = len(who) <= COMPLETE, _arcs(table, who)
    work = PROOF_WORK
    for size, names in ((2, who), (3, who if small else stuck[:12])):
        for group in combinations(names, size):
            if work > 0 and _linked(group, arcs):
                found = search(table, PROOF, group)
                work -= found.expanded
                if found.exhausted:
                    return group
    return ()


def _arcs(table: Conflicts, who: Sequence[int]) -> set[tuple[int, int]]:
    """Return the pairs (a, b) where, in some hold, `a` must move before `b`: it stands in the way of `b`, or `b` at
    its goal would stand in its way."""
    needs = {i: table.hindrances(i) for i in who}
    goals = {i: sum_of(table.bit(i, g) for g in table.movers[i].goals) for i in who}
    return {(a, b) for a in who for b in who if a != b and (needs[b] & table.bit(a, 0) or needs[a] & goals[b])}


def _linked(group: Sequence[int], arcs: set[tuple[int, int]]) -> bool:
    """Whether each of the group waits for another of it and is waited for, as in a ring."""
    return all(any((a, b) in arcs for b in group) and any((b, a) in arcs for b in group) for a in group)
