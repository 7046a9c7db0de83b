"""Nearest neighbor: each time the cheapest operation that waits for nothing."""

from __future__ import annotations

from pico.staging.sequencing.problem import Tour


def nearest_order(tour: Tour) -> tuple[int, ...]:
    """Return the order in which each operation is the cheapest to go to from the one before; a tie goes to the lower
    index."""
    done, at, order = 0, tour.count, list[int]()
    while len(order) < tour.count:
        ready = (j for j in range(tour.count) if not done >> j & 1 and not tour.before[j] & ~done)
        at = min(ready, key=lambda j: (tour.arcs[at][j], j))
        done |= 1 << at
        order.append(at)
    return tuple(order)
