"""The radius of a focused beam along its axis: its square is a parabola of the distance, w^2 = a + b z + c z^2."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping

import numpy as np

from pico.optimize.problem import Declaration, Problem, Short, noise_of
from pico.optimize.stepwise import Result, Steps, Stepwise

DECLARATION = Declaration(
    what="a parabola through the squares of radii, to a radius or to the waist",
    aims=("reach", "minimize"), variables=(1, 1), parameters={"step": 0.4, "within": 0.02}, usual=5,
)  # fmt: skip
"""`step`: of the second and third measurement, as a share of how far the best value is likely to be; `within`: of a
waist, the share of the range in which it must be known."""
_MOST = 12
_FAINT = 1e-6


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    return Stepwise(problem, _steps(problem, parameters))


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    variable, output = problem.variables[0], problem.outputs[0]
    seen: list[Result] = []
    at, step, before = variable.start, parameters["step"] * variable.likely, math.inf
    for _ in range(_MOST):
        result = yield {variable.name: at}
        if problem.measured(result):
            seen.append(result)
            off = abs(result[output] - problem.target.get(output, 0.0)) + result.get(f"{output}_sigma", 0.0)
            if problem.aim == "reach" and off <= problem.tolerance.get(output, 0.0):
                return "the goal is reached"
        elif not seen:
            return Short("there is nothing to see where it began")
        if len({r[variable.name] for r in seen}) < 3:
            outward = len(seen) == 1 or seen[-1][output] < seen[0][output]
            step = step if problem.measured(result) else step / 2
            turn = 1 if variable.within(seen[-1][variable.name] + step) == seen[-1][variable.name] + step else -1
            base = seen[-1][variable.name] if outward else seen[0][variable.name]
            at = variable.within(base + (turn if outward else -1) * step)
            if any(r[variable.name] == at for r in seen):
                at = variable.within(base - turn * step / 2)
            continue
        at = _next(problem, seen)
        if not problem.measured(result):
            continue  # where the parabola has it nothing was read yet
        if problem.aim == "minimize" and abs(at - before) <= parameters["within"] * variable.span:
            return "the waist is found"
        before = at
        if any(abs(r[variable.name] - at) < 1e-9 * variable.span for r in seen) and problem.aim == "reach":
            return "the radius is as near as it can be within the bounds"
    return Short("it comes no nearer")


def _next(problem: Problem, seen: list[Result]) -> float:
    """Return where the parabola through what was seen has what is wanted."""
    variable, output = problem.variables[0], problem.outputs[0]
    z = np.array([r[variable.name] for r in seen])
    most = max(abs(r[output]) for r in seen) or 1.0
    w = np.array([r[output] / most for r in seen])
    sigma = np.array([(noise_of(r, output) / most) or 0.003 * abs(r[output] / most) for r in seen])
    weight = 1 / (2 * np.maximum(np.abs(w), _FAINT) * np.clip(sigma, _FAINT, 1 / _FAINT))
    middle, scale = variable.start, variable.span
    with warnings.catch_warnings(action="ignore", category=np.exceptions.RankWarning):  # then it is along the line
        c, b, a = np.polyfit((z - middle) / scale, w**2, 2, w=weight)
    low, high = ((end - middle) / scale for end in (variable.low, variable.high))
    if c <= 0:  # no hyperbola: along the line
        return variable.low if b > 0 else variable.high
    bottom = -b / (2 * c)
    if problem.aim == "minimize":
        return variable.within(middle + scale * min(high, max(low, bottom)))
    square = (problem.target.get(output, 0.0) / most) ** 2
    root = math.sqrt(max(0.0, b * b - 4 * c * (a - square))) / (2 * c)
    inside = [u for u in (bottom - root, bottom + root) if low <= u <= high]
    last = (seen[-1][variable.name] - middle) / scale
    best = min(inside, key=lambda u: abs(u - last), default=min(high, max(low, bottom)))
    return variable.within(middle + scale * float(best))
