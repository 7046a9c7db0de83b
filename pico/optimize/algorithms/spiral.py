"""A spiral around where the light should be, until it is seen."""

from __future__ import annotations

from collections.abc import Mapping

from pico.optimize.problem import Declaration, Problem
from pico.optimize.search import PARAMETERS, searched, spiral
from pico.optimize.stepwise import Stepwise

DECLARATION = Declaration(
    what="rings around where it should be, until light is seen", aims=("reach", "minimize", "maximize"),
    variables=(1, 2), outputs=(1, 12), parameters=PARAMETERS, usual=60,
)  # fmt: skip


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    places = spiral()
    if len(problem.variables) == 1:
        places = ((n // 2 * (1.0 if n % 2 else -1.0), 0.0) for n in range(1, 1000))
    return Stepwise(problem, searched(problem, places, parameters))
