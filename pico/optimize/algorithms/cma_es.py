"""CMA-ES, as the package `cmaes` has it (Hansen's evolution strategy): for rough landscapes, at many measurements."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from pico.optimize.problem import Declaration, Problem, Short, missing
from pico.optimize.stepwise import Steps, Stepwise

DECLARATION = Declaration(
    what="an evolution strategy (the extra `optimize`), for rough landscapes",
    aims=("reach", "minimize", "maximize"), variables=(2, 12), outputs=(1, 12),
    parameters={"step": 0.3, "within": 0.003, "generations": 100}, usual=150,
)  # fmt: skip
"""`step`: the first standard deviation, as a share of how far the best point is likely to be; `within`: the last, as a
share of the range."""
_DARK = 1e6


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem; raises PicoError where the package is not installed."""
    try:
        import cmaes
    except ImportError as exc:
        raise missing("cma_es", "cmaes") from exc
    start = np.array([(v.start - v.low) / v.span for v in problem.variables])
    sigma = parameters["step"] * max(v.likely / v.span for v in problem.variables)
    strategy = cmaes.CMA(mean=start, sigma=sigma, bounds=np.array([[0.0, 1.0]] * len(start)), seed=seed)
    return Stepwise(problem, _steps(problem, parameters, strategy))


def _steps(problem: Problem, parameters: Mapping[str, float], strategy: Any) -> Steps:
    for _ in range(int(parameters["generations"])):
        told = []
        for _ in range(strategy.population_size):
            at = strategy.ask()
            result = yield {v.name: v.low + float(u) * v.span for v, u in zip(problem.variables, at, strict=True)}
            if problem.met(result):
                return "the goal is reached"
            cost = problem.cost(result)
            told.append((at, cost if math.isfinite(cost) else _DARK))
        strategy.tell(told)
        costs = [cost for _, cost in told]
        if max(costs) - min(costs) <= 2 * problem.noise(result):
            return "a generation differs by no more than the noise"
        if strategy.should_stop():
            return "the strategy has converged"
    return Short("all generations were tried")
