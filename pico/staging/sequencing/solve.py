"""The cheapest order: proven where the problem is small, a good one and how good it is where not."""

from __future__ import annotations

from collections import abc
from typing import TYPE_CHECKING

from pico.staging.sequencing.exchange import NEAR, anneal
from pico.staging.sequencing.nearest import nearest_order
from pico.staging.sequencing.problem import TOLERANCE, Effort, Sequence, Tour, read_tour

if TYPE_CHECKING:
    from pico.staging.sequencing.assignment import Assignment

SHARE = 1000
"""Moves of the local search an operation before the exact search; a good order makes that one short."""


def best_order(
    start: abc.Sequence[float],
    between: abc.Sequence[abc.Sequence[float]],
    end: abc.Sequence[float],
    before: abc.Sequence[abc.Set[int]],
    *,
    limit: Effort = Effort(),  # noqa: B008
    first: abc.Sequence[int] | None = None,
) -> Sequence:
    """Return the cheapest order of m operations that is found within `limit`, and a bound.

    `start[j]`: the cost of going to operation j first (m). `between[i][j]`: of going from i to j (m x m, without
    the diagonal). `end[i]`: of stopping after i (m). `before[j]`: what must come before j. `first`: an order that
    keeps that, to begin with. The same input has the same answer everywhere. Raises ValueError where sizes differ,
    a cost is not finite, or the precedence has a ring.
    """
    tour = read_tour(start, between, end, before)
    order = nearest_order(tour) if first is None else tuple(first)
    if tour.count < 2:
        return _proven(tour, order)
    from pico.staging.sequencing.assignment import assign
    from pico.staging.sequencing.exact import MOST, improved
    from pico.staging.sequencing.stretches import rearranged

    floor = assign(tour)
    near = _near(floor)
    if tour.count <= MOST:
        order = anneal(tour, order, near, min(limit.moves, SHARE * tour.count), limit.seed)
        ended, order = improved(tour, order, limit.steps)
        if ended:
            return _proven(tour, order)
    order = rearranged(tour, anneal(tour, order, near, limit.moves, limit.seed), limit.sweeps)
    return _bounded(tour, order, floor, limit)


def tightened(
    start: abc.Sequence[float],
    between: abc.Sequence[abc.Sequence[float]],
    end: abc.Sequence[float],
    before: abc.Sequence[abc.Set[int]],
    found: Sequence,
    limit: Effort,
) -> Sequence:
    """Return what `best_order` found, by itself without rounds, with the bound that the rounds of `limit` lead to."""
    if found.proven:
        return found
    from pico.staging.sequencing.assignment import assign

    tour = read_tour(start, between, end, before)
    return _bounded(tour, found.order, assign(tour), limit)


def _proven(tour: Tour, order: tuple[int, ...]) -> Sequence:
    cost = tour.cost(order)
    return Sequence(order, cost, cost, True)


def _bounded(tour: Tour, order: tuple[int, ...], floor: Assignment, limit: Effort) -> Sequence:
    from pico.staging.sequencing.cuts import cut_bound

    cost, bound = tour.cost(order), floor.bound
    if limit.rounds and bound < cost - TOLERANCE * abs(cost):
        bound = cut_bound(tour, order, floor, limit)
    bound = min(bound, cost)
    return Sequence(order, cost, bound, bound >= cost - TOLERANCE * abs(cost))


def _near(floor: Assignment) -> tuple[tuple[int, ...], ...]:
    """Return the good successors of each operation: those whose arcs cost least beyond the assignment."""
    import numpy as np

    ranked = np.argsort(floor.excess, axis=1, kind="stable")[:, :NEAR]
    return tuple(
        tuple(int(j) for j in row if floor.excess[i, j] < float("inf")) for i, row in enumerate(ranked)
    )  # fmt: skip
