"""The cheapest order, by dynamic programming over the sets of operations that may be done first.

For each such set and each last operation of it the cheapest way there is kept, one layer of sets after the other, as
far as it can still lead to an order cheaper than the best known. Costs are excesses over the assignment bound, so that
the cost of a beginning is at the same time a bound for every order that begins so.
"""

from __future__ import annotations

from typing import Any

from pico.staging.sequencing.problem import TOLERANCE, Tour

MOST = 30
"""Operations up to which the search is tried."""

Layer = tuple[Any, Any]
"""Sets of operations as bits, ascending, (n,); the least cost for each last operation and set, (m + 1, n)."""


def improved(tour: Tour, order: tuple[int, ...], steps: int) -> tuple[bool, tuple[int, ...]]:
    """Return whether the search ended within so many steps, and a cheaper order where it found one, else `order`."""
    from pico.staging.sequencing.assignment import assign

    floor, cost = assign(tour), tour.cost(order)
    room = cost - floor.bound - TOLERANCE * abs(cost)
    if room <= 0:
        return True, order
    ended, found = cheapest_below(tour, floor.excess, room, steps)
    return ended, found or order


def cheapest_below(tour: Tour, excess: Any, limit: float, steps: int) -> tuple[bool, tuple[int, ...] | None]:
    """Return whether the search came to an end within so many steps, and then the cheapest order whose excess is below
    `limit`, or None where there is none. `excess`: (m + 1, m + 1), not negative."""
    import numpy as np

    count = tour.count
    begin = np.full((count + 1, 1), np.inf)
    begin[count] = 0.0
    layers: list[Layer] = [(np.zeros(1, np.int64), begin)]
    for _ in range(count):
        steps -= len(layers[-1][0]) * count * count
        if steps < 0:
            return False, None
        following = _next_layer(layers[-1], tour, excess, limit)
        if following is None:
            return True, None
        layers.append(following)
    if not (layers[-1][1][:, 0] + excess[:, count]).min() < limit:
        return True, None
    return True, _trace(layers, excess)


def _next_layer(layer: Layer, tour: Tour, excess: Any, limit: float) -> Layer | None:
    """Return the sets with one operation more; None where no way is cheap enough."""
    import numpy as np

    sets, costs = layer
    found = []
    for j, before in enumerate(tour.before):
        ready = np.flatnonzero((sets & (before | 1 << j)) == before)
        best = (costs[:, ready] + excess[:, j, None]).min(axis=0)
        cheap = best < limit
        if cheap.any():
            found.append((j, sets[ready[cheap]] | 1 << j, best[cheap]))
    if not found:
        return None
    grown = np.unique(np.concatenate([to for _, to, _ in found]))
    table = np.full((tour.count + 1, len(grown)), np.inf)
    for j, to, best in found:
        table[j, np.searchsorted(grown, to)] = best
    return grown, table


def _trace(layers: list[Layer], excess: Any) -> tuple[int, ...]:
    """Return the order that leads to the last layer at the least cost, found from its end."""
    import numpy as np

    at, order = len(layers) - 1, list[int]()
    done = (1 << at) - 1
    for sets, costs in reversed(layers[1:]):
        at = int(np.argmin(costs[:, np.searchsorted(sets, done)] + excess[:, at]))
        done ^= 1 << at
        order.append(at)
    return tuple(reversed(order))
