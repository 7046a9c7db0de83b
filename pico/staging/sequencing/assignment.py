"""The cheapest assignment of a successor to every operation: a bound, and what each arc costs beyond it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pico.staging.sequencing.problem import Tour


@dataclass(frozen=True, slots=True)
class Assignment:
    """`bound`: no order costs less. `excess[i, j]`: by how much at least an order with the arc i -> j costs more than
    the bound; infinite where j can't come right after i. Array (m + 1, m + 1)."""

    bound: float
    excess: Any


def assign(tour: Tour) -> Assignment:
    """Return the assignment bound over the arcs that precedence allows."""
    import numpy as np

    size = tour.count + 1
    follows = [[after >> j & 1 for j in range(size)] for after in map(tour.successors, range(size))]
    costs = np.where(np.array(follows, bool), np.array(tour.arcs), np.inf)
    rows, columns = duals(costs)
    excess = np.maximum(costs - rows[:, None] - columns[None, :], 0.0)
    return Assignment(float(rows.sum() + columns.sum()), excess)


def duals(costs: Any) -> tuple[Any, Any]:
    """Return potentials u, v with u[i] + v[j] <= costs[i, j] and the greatest sum: the Hungarian method, one shortest
    augmenting path a row. `costs` (n, n) may hold inf, but must have a finite assignment."""
    import numpy as np

    size = len(costs)
    u, v = np.zeros(size), np.zeros(size)
    row_of = np.full(size, -1)
    for row in range(size):
        lengths, parents = np.full(size, np.inf), np.full(size, -1)
        seen = np.zeros(size, bool)
        at, column, length = row, -1, 0.0
        while at >= 0:
            through = np.where(seen, np.inf, costs[at] - u[at] - v + length)
            closer = through < lengths
            lengths[closer], parents[closer] = through[closer], column
            column = int(np.argmin(np.where(seen, np.inf, lengths)))
            length = float(lengths[column])
            seen[column] = True
            at = int(row_of[column])
        seen[column] = False
        u[row] += length
        u[row_of[seen]] += length - lengths[seen]
        v[seen] -= length - lengths[seen]
        while column >= 0:
            previous = int(parents[column])
            row_of[column] = row if previous < 0 else row_of[previous]
            column = previous
    return u, v
