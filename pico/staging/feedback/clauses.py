"""The cheapest choice that meets every clause: a binary program, solved by HiGHS, to which clauses are added."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from pico.staging.feedback.limit import WorkLeft

SMALL = 2000
"""Entries of a program up to which a node of it counts as one; of a larger one, whose linear programs are longer as
well, it counts as the square of how many times larger that is."""
CLOSE = 1e-5
"""Broken costs that differ by less than this, relatively, are alike: so far the solver's tolerances reach."""


def reached(cost: float, bound: float) -> bool:
    """Whether nothing can be cheaper than `cost`, given a lower bound."""
    return cost <= bound + CLOSE * (1.0 + abs(cost))


@dataclass(frozen=True, slots=True)
class CoverAnswer:
    """An answer of a `Cover`: the variables chosen (None where no choice was found), a proven lower bound on the cost,
    and whether it is proven that no choice meets the clauses."""

    chosen: frozenset[int] | None
    bound: float
    infeasible: bool = False


class Cover:
    """Variables 0..n-1 are chosen or not; `costs` are at least 0. Clauses say that one of some variables is
    chosen, or more; groups that exactly one is."""

    def __init__(self, costs: Sequence[float]) -> None:
        import highspy
        import numpy as np

        self.costs = tuple(costs)
        self.integral = all(float(c).is_integer() for c in costs)
        highs: Any = highspy
        self._highs = highs.Highs()
        for name, value in (
            ("output_flag", False), ("threads", 1), ("random_seed", 0), ("mip_rel_gap", 0.0), ("mip_abs_gap", 1e-7),
        ):  # fmt: skip
            self._highs.setOptionValue(name, value)
        count = len(self.costs)
        every = np.arange(count, dtype=np.int32)
        self._highs.addVars(count, np.zeros(count), np.ones(count))
        self._highs.changeColsCost(count, every, np.array(self.costs, dtype=float))
        kinds = np.full(count, highspy.HighsVarType.kInteger.value, dtype=np.uint8)
        self._highs.changeColsIntegrality(count, every, kinds)

    def one_of(self, variables: Iterable[int]) -> None:
        """Demand that one of the variables is chosen, or more."""
        self._row(variables, 1.0, math.inf)

    def exactly_one(self, variables: Iterable[int]) -> None:
        """Demand that one of the variables is chosen and no more."""
        self._row(variables, 1.0, 1.0)

    def _row(self, variables: Iterable[int], low: float, high: float) -> None:
        import numpy as np

        columns = np.array(sorted(variables), dtype=np.int32)
        self._highs.addRow(low, high, len(columns), columns, np.ones(len(columns)))

    def relaxed(self) -> tuple[tuple[float, ...], float]:
        """Return how far each variable is chosen in the cheapest choice where that may be in part, from 0 to 1, and
        what every choice costs at least; nothing and 0 where there is none."""
        import highspy

        self._highs.setOptionValue("solve_relaxation", True)
        self._highs.run()
        self._highs.setOptionValue("solve_relaxation", False)
        if self._highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
            return (), 0.0
        return tuple(self._highs.getSolution().col_value), self.rounded(self._highs.getInfo().objective_function_value)

    def solve(self, work: WorkLeft, start: frozenset[int] | None = None, known: float = 0.0) -> CoverAnswer:
        """Return the cheapest choice, or the best found until `work` is spent; `start` is a choice to begin with.
        `known`: what every choice is known to cost at least; one that costs no more is not proven once again."""
        import highspy
        import numpy as np

        highs = self._highs
        work.solves -= 1
        each = max(1, (highs.getNumNz() // SMALL) ** 2)
        highs.setOptionValue("mip_max_nodes", max(1, work.nodes // each))
        highs.setOptionValue("objective_target", known + CLOSE)
        if start is not None:
            values = np.array([float(v in start) for v in range(len(self.costs))])
            highs.setSolution(len(values), np.arange(len(values), dtype=np.int32), values)
        highs.run()
        info = highs.getInfo()
        work.nodes -= each * max(0, info.mip_node_count)
        if highs.getModelStatus() == highspy.HighsModelStatus.kInfeasible:
            return CoverAnswer(None, math.inf, True)
        return CoverAnswer(self._chosen(info), self.rounded(info.mip_dual_bound))

    def _chosen(self, info: Any) -> frozenset[int] | None:
        if not math.isfinite(info.objective_function_value) or info.primal_solution_status != 2:
            return None
        values = self._highs.getSolution().col_value
        return frozenset(v for v, x in enumerate(values) if x > 0.5)

    def rounded(self, bound: float) -> float:
        """Return a bound, raised to the next cost that is possible where all are whole."""
        return max(0.0, math.ceil(bound - CLOSE) if self.integral else bound)
