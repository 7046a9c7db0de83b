"""The assignment program with cuts, over the arcs that are good by themselves: of a hundred thousand, some thousands.

Any potentials of the rows, those of cuts not negative, give a bound: each operation is left by one arc, which costs at
least what its potentials and those of the cuts that it serves say, and what its reduced cost is below that (Lagrange).
So the bound is one over all arcs, however few the program has, and also where it was stopped; arcs that would lower it
join the program.
"""

from __future__ import annotations

from collections import abc
from typing import Any

from pico.staging.sequencing.problem import Tour

Cut = tuple[int, int]
"""Two sets of operations as bits, the start and the park among them as bit m: one arc at least goes from the first to
the second."""

GOOD = 20
"""How many arcs out of each operation the program has at first, and into each."""
PRICINGS = 3
"""How often it is solved again because arcs joined it."""
LOWER = 1e-7
"""An arc joins where its reduced cost is so far below 0; costs of the program are at most 1."""


class CutProgram:
    """Every operation is entered and left once, and every cut is served. `pivots`: how many it may still take."""

    def __init__(self, tour: Tour, order: abc.Sequence[int], excess: Any, pivots: int) -> None:
        """`order` keeps the precedence; its arcs are in the program, so that it has a solution. `excess`: see
        `Assignment`."""
        import highspy
        import numpy as np

        self._size = size = tour.count + 1
        self.pivots = pivots
        allowed = np.isfinite(excess)
        costs = np.array(tour.arcs)
        self._scale = float(np.abs(costs[allowed]).max()) or 1.0
        self._costs = np.where(allowed, costs / self._scale, np.inf)
        self._has = _good(excess, allowed, (tour.count, *order, tour.count))
        self._program: Any = highspy.Highs()  # type: ignore[no-untyped-call]
        for option, value in (("output_flag", False), ("threads", 1), ("random_seed", 0)):
            self._program.setOptionValue(option, value)
        self._arcs = np.empty((0, 2), int)
        self._leaves, self._enters = np.empty((0, size), bool), np.empty((0, size), bool)
        self._add_arcs(self._has)
        one, every = np.repeat(np.eye(size, dtype=bool), 2, axis=0), np.ones(size, bool)
        out = (np.arange(2 * size) % 2 == 0)[:, None]
        self._add_rows(np.where(out, one, every), np.where(out, every, one), 1.0)

    def bound(self) -> float:
        """Return a cost that no order beats which serves the cuts: the least that the program has, as far as it may
        still be worked on."""
        best = -float("inf")
        for _ in range(1 + PRICINGS):
            if self.pivots <= 0:
                break
            self._program.setOptionValue("simplex_iteration_limit", self.pivots)
            self._program.run()
            self.pivots -= max(1, self._program.getInfo().simplex_iteration_count)
            value, reduced = self._priced()
            best = max(best, value)
            new = (reduced < -LOWER) & ~self._has
            if not new.any():
                break
            self._has |= new
            self._add_arcs(new)
        return best

    def used(self, least: float) -> list[tuple[int, int, float]]:
        """Return the arcs that the last solution uses more than that, with their shares."""
        shares = self._program.getSolution().col_value
        return [(i, j, x) for (i, j), x in zip(self._arcs.tolist(), shares, strict=False) if x > least]

    def add(self, cuts: abc.Sequence[Cut]) -> None:
        """Have these cuts served, too."""
        import numpy as np

        sides = np.array([[[mask >> k & 1 for k in range(self._size)] for mask in cut] for cut in cuts], bool)
        self._add_rows(sides[:, 0], sides[:, 1], np.inf)

    def _priced(self) -> tuple[float, Any]:
        """Return the bound that the potentials of the rows give, and what each arc costs beyond them."""
        import numpy as np

        potentials = np.array(self._program.getSolution().row_dual)
        potentials[2 * self._size :] = np.maximum(potentials[2 * self._size :], 0.0)
        reduced = self._costs - (self._leaves * potentials[:, None]).T @ self._enters.astype(float)
        return self._scale * float(potentials.sum() + reduced.min(axis=1).sum()), reduced

    def _add_arcs(self, which: Any) -> None:
        import numpy as np

        new, count = np.argwhere(which), int(which.sum())
        arc, row = np.nonzero((self._leaves[:, new[:, 0]] & self._enters[:, new[:, 1]]).T)
        self._program.addCols(
            count, self._costs[which], np.zeros(count), np.ones(count), len(row), _begins(arc, count),
            row.astype(np.int32), np.ones(len(row)),
        )  # fmt: skip
        self._arcs = np.concatenate([self._arcs, new])

    def _add_rows(self, leaves: Any, enters: Any, most: float) -> None:
        """Add 1 <= the arcs used from one side to the other <= most, for each row of (n, m + 1)."""
        import numpy as np

        count = len(leaves)
        row, arc = np.nonzero(leaves[:, self._arcs[:, 0]] & enters[:, self._arcs[:, 1]])
        self._program.addRows(
            count, np.ones(count), np.full(count, most), len(arc), _begins(row, count), arc.astype(np.int32),
            np.ones(len(arc)),
        )  # fmt: skip
        self._leaves = np.concatenate([self._leaves, leaves])
        self._enters = np.concatenate([self._enters, enters])


def _begins(of: Any, count: int) -> Any:
    """Return where each of `count` begins in an ascending list."""
    import numpy as np

    return np.searchsorted(of, np.arange(count)).astype(np.int32)


def _good(excess: Any, allowed: Any, line: abc.Sequence[int]) -> Any:
    """Return which arcs are among the cheapest beyond the assignment out of an operation or into one, or in a line."""
    import numpy as np

    good = np.zeros(excess.shape, bool)
    every = np.arange(len(excess))
    good[every[:, None], np.argsort(excess, axis=1, kind="stable")[:, :GOOD]] = True
    good[np.argsort(excess, axis=0, kind="stable")[:GOOD], every] = True
    good &= allowed
    good[line[:-1], line[1:]] = True
    return good
