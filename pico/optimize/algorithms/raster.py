"""Row by row over the whole range, until light is seen."""

from __future__ import annotations

from collections.abc import Mapping

from pico.optimize.problem import Declaration, Problem
from pico.optimize.search import PARAMETERS, raster, searched
from pico.optimize.stepwise import Stepwise

DECLARATION = Declaration(
    what="rows over as far as the best point is likely to be, until light is seen",
    aims=("reach", "minimize", "maximize"), variables=(1, 2), outputs=(1, 12), parameters=PARAMETERS, usual=80,
)  # fmt: skip


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    count = max(1, round(1 / parameters["pitch"]))
    up = count if len(problem.variables) == 2 else 0
    return Stepwise(problem, searched(problem, raster(count, up), parameters))
