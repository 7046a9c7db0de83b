"""What is to be ordered: operations as indices, costs as numbers, and what must come before what.

This is the sequential ordering problem: an open tour through all operations with asymmetric costs and a partial order.
Operation m stands for where the arm is before the first operation, and for where it parks after the last.
"""

from __future__ import annotations

from collections import abc
from dataclasses import dataclass

Masks = tuple[int, ...]
"""For each operation a set of operations, as bits."""

TOLERANCE = 1e-9
"""Two costs that differ by less than this share are the same."""


@dataclass(frozen=True, slots=True)
class Effort:
    """How hard to try; counts of work, never time, so that the same problem always has the same answer.

    `moves`: exchanges that the local search tries. `steps`: additions that the exact search may take (enough for any
    18 operations). `sweeps`: how often an order that it does not prove is gone through, stretch by stretch, while it
    becomes cheaper. `rounds`: how often the bound is tightened where the exact search does not end, and `pivots`: how
    many steps of its linear programs that may take.
    """

    moves: int = 1_200_000
    steps: int = 85_000_000
    sweeps: int = 4
    rounds: int = 6
    pivots: int = 100_000
    seed: int = 0


@dataclass(frozen=True, slots=True)
class Sequence:
    """An order of all operations, its cost, and a cost that no order can beat; `proven`: no order is cheaper by more
    than one part in 10^9."""

    order: tuple[int, ...]
    cost: float
    lower_bound: float
    proven: bool


@dataclass(frozen=True, slots=True)
class Tour:
    """The problem as one table: `arcs[i][j]` is the cost from operation i to j, row and column m those of the start
    and the park; `before` and `after` hold all operations that must come earlier and later, directly or not."""

    arcs: tuple[tuple[float, ...], ...]
    before: Masks
    after: Masks

    @property
    def count(self) -> int:
        return len(self.before)

    def cost(self, order: abc.Sequence[int]) -> float:
        """Return what an order costs, summed from its first operation on."""
        at, total = self.count, 0.0
        for k in (*order, self.count):
            total += self.arcs[at][k]
            at = k
        return total

    def successors(self, i: int) -> int:
        """Return what may come right after i in some order, as bits: neither later than something between, nor earlier;
        the park is bit m."""
        if i == self.count:
            return sum(1 << j for j, earlier in enumerate(self.before) if not earlier)
        if not self.after[i]:
            return (2 << self.count) - 1 & ~(self.before[i] | 1 << i)
        far, left = 0, self.after[i]
        while left:
            low = left & -left
            far |= self.after[low.bit_length() - 1]
            left &= ~(low | far)
        return (1 << self.count) - 1 & ~(self.before[i] | 1 << i | far)


def read_tour(
    start: abc.Sequence[float],
    between: abc.Sequence[abc.Sequence[float]],
    end: abc.Sequence[float],
    before: abc.Sequence[abc.Set[int]],
) -> Tour:
    """Return the tables as one. Raises ValueError where they do not fit together, a cost is not finite, or the
    operations wait for one another in a ring."""
    count = len(start)
    if not (len(between) == len(end) == len(before) == count and all(len(row) == count for row in between)):
        raise ValueError(f"costs and precedence must be for the same {count} operations")
    rows = [(*map(float, row), float(last)) for row, last in zip(between, end, strict=True)]
    arcs = (*rows, (*map(float, start), 0.0))
    if not all(abs(c) < float("inf") for i, row in enumerate(arcs) for j, c in enumerate(row) if i != j):
        raise ValueError("every cost must be a finite number")
    earlier = closure(before)
    later = tuple(sum(1 << j for j in range(count) if earlier[j] >> i & 1) for i in range(count))
    return Tour(arcs, earlier, later)


def closure(before: abc.Sequence[abc.Set[int]]) -> Masks:
    """Return for each operation all that must come before it. Raises ValueError for a ring or an unknown index."""
    count = len(before)
    if any(not 0 <= e < count for earlier in before for e in earlier):
        raise ValueError(f"precedence must name operations 0 to {count - 1}")
    direct, masks, done = [sum(1 << e for e in earlier) for earlier in before], [0] * count, 0
    left = list(range(count))
    while left:
        ready = [j for j in left if not direct[j] & ~done]
        if not ready:
            raise ValueError(f"operations wait for one another: {', '.join(map(str, left))}")
        for j in ready:
            for e in before[j]:
                if not masks[j] >> e & 1:  # else all that comes before it is there, too
                    masks[j] |= masks[e] | 1 << e
        done |= sum(1 << j for j in ready)
        left = [j for j in left if not done >> j & 1]
    return tuple(masks)
