"""Whether what was measured says that a search ended at the best, and not in noise or at the end of an axis."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from pico.optimize.problem import Problem, Short, Variable

FLICKER = 0.002
"""By which share a laser is another from reading to reading, which no standard deviation of one reading tells."""
_APART = 5.0
"""Standard deviations by which the best and the worst of many readings of the same may differ."""
_AT = 1e-3
"""How near a bound is at it, in the range."""
Result = Mapping[str, float]


def same(problem: Problem, results: Sequence[Result]) -> bool:
    """Return whether results of a power, or of what else is as high or as low as can be, differ by no more than their
    noise."""
    output = problem.outputs[0]
    best, worst = min(results, key=problem.cost), max(results, key=problem.cost)
    noise = math.hypot(*(math.hypot(problem.noise(r), FLICKER * r[output]) for r in (best, worst))) / math.sqrt(2)
    return problem.cost(worst) - problem.cost(best) <= _APART * noise


def ends(problem: Problem, result: Result) -> list[Variable]:
    """Return the tunables that may go no further than where a result has them, on the side on which they are."""
    return [
        v for v in problem.variables
        if not (v.period and v.period <= v.span)
        and min(result[v.name] - v.low, v.high - result[v.name]) <= max(_AT * v.span, v.resolution)
    ]  # fmt: skip


def unsaid(problem: Problem, results: Sequence[Result], last: Result) -> Short | None:
    """Return why readings do not say that `last`, the best of `results`, is as good as it gets; None where they do."""
    if same(problem, results):
        return Short("nothing that was tried changed it by more than its noise")
    if ends_at := ends(problem, last):
        told = " and ".join(f"{v.name} is at its bound of {min((v.low, v.high), key=lambda b: abs(b - last[v.name])):g}"
                            for v in ends_at)  # fmt: skip
        return Short(f"{told}: beyond it there may be {'more' if problem.aim == 'maximize' else 'less'}")
    return None
