"""Newton's method on a vector of readings, its Jacobian kept up by Broyden's rule. It begins with that of the model of
the light; where there is none, or where it leads no nearer, it is measured first.

C. G. Broyden, Math. Comp. 19, 577 (1965). As many readings as tunables, or more: then in the least squares.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping

import numpy as np
from numpy.typing import NDArray

from pico.optimize.problem import Declaration, Point, Problem, Variable
from pico.optimize.stepwise import Result, Steps, Stepwise

DECLARATION = Declaration(
    what="Newton's method on readings that follow the tunables nearly linearly, such as a centroid",
    aims=("reach",), variables=(1, 6), outputs=(1, 12), parameters={"probe": 0.2, "most": 30}, usual=6,
    told=3,
)  # fmt: skip
"""`probe`: the first step of each tunable, as a share of how far its best value is likely to be; `most`: steps."""
REACHED = "the goal is reached"
_NEARER = 0.5
"""Of how far off it was, what a first step by the model is to leave at most for the model to be believed."""
_IN_VAIN = 5
_SMALLEST = 1e-3
Array = NDArray[np.float64]


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    return Stepwise(problem, _steps(problem, parameters))


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    here = yield problem.start
    if not problem.measured(here):
        return "there is nothing to see where it began"
    if _surely(problem, here):
        return REACHED
    jacobian = _told(problem)
    if jacobian is not None:
        there = yield _stepped(problem, jacobian, here)
        if problem.measured(there) and _surely(problem, there):
            return REACHED
        nearer = problem.measured(there) and problem.cost(there) < _NEARER * problem.cost(here)
        jacobian, here = (_kept_up(problem, jacobian, here, there), there) if nearer else (None, here)
    if jacobian is None:
        columns: list[Array] = []
        for variable in problem.variables:
            there, why = yield from _probe(problem, variable, here, parameters["probe"] * variable.likely)
            if why:
                return why
            columns.append(
                (_values(problem, there) - _values(problem, here)) / (there[variable.name] - here[variable.name])
            )
            here = there if problem.cost(there) < problem.cost(here) else here
        jacobian = np.stack(columns, axis=1)
    best, vain, reach = here, 0, 1.0
    for _ in range(int(parameters["most"])):
        there = yield _stepped(problem, jacobian, here, reach)
        better = False
        if problem.measured(there):
            if _surely(problem, there):
                return REACHED
            jacobian = _kept_up(problem, jacobian, here, there)
            better = problem.cost(there) < problem.cost(best) - problem.noise(there)
            here, reach = there, min(1.0, 2 * reach)
        else:
            reach /= 2  # too far: the light is lost there
        best, vain = (there, 0) if better else (best, vain + 1)
        if vain >= _IN_VAIN:
            break
        here = best if vain >= 2 else here  # it goes away from there
    return REACHED if problem.met(best) else "it comes no nearer"


def _probe(
    problem: Problem, variable: Variable, here: Result, step: float
) -> Generator[Point, Result, tuple[Result, str]]:
    """Move one tunable until something is measured, and return that; or why that cannot be."""
    name = variable.name
    step = step if here[name] + step <= variable.high else -step
    while abs(step) >= _SMALLEST * variable.span:
        there = yield {**_at(problem, here), name: here[name] + step}
        if problem.measured(there) and there[name] != here[name]:
            return there, REACHED if _surely(problem, there) else ""
        step = -step / 2 if step > 0 else -step
    return here, f"{name} cannot be moved without losing the light"


def _told(problem: Problem) -> Array | None:
    """Return the Jacobian that the model of the light tells, a row an output; None where it tells none."""
    slopes = np.array(problem.nominal.slopes if problem.nominal else (), dtype=np.float64)
    fits = slopes.shape == (len(problem.outputs), len(problem.variables))
    return slopes if fits and bool(np.isfinite(slopes).all() and slopes.any(axis=0).all()) else None


def _stepped(problem: Problem, jacobian: Array, here: Result, reach: float = 1.0) -> Point:
    """Return where a Jacobian has the target, or a share (`reach`) of the way there."""
    off = _values(problem, here) - _target(problem)
    step = -np.linalg.lstsq(jacobian, off, rcond=1e-6)[0] * reach
    return {v.name: here[v.name] + float(s) for v, s in zip(problem.variables, step, strict=True)}


def _kept_up(problem: Problem, jacobian: Array, here: Result, there: Result) -> Array:
    """Return the Jacobian that agrees with the last step, and differs least from the one before."""
    moved = np.array([there[v.name] - here[v.name] for v in problem.variables])
    square = float(moved @ moved)
    if not square:
        return jacobian
    change = _values(problem, there) - _values(problem, here)
    return jacobian + np.outer(change - jacobian @ moved, moved) / square


def _surely(problem: Problem, result: Result) -> bool:
    """Whether a result is within tolerance by more than one standard deviation."""
    if not problem.met(result):
        return False
    off = problem.off(result)
    return all(abs(o) + result.get(f"{n}_sigma", 0.0) <= problem.tolerance.get(n, 0.0) for n, o in off.items())


def _at(problem: Problem, result: Result) -> Point:
    return {v.name: result[v.name] for v in problem.variables}


def _values(problem: Problem, result: Result) -> Array:
    return np.array([result[name] for name in problem.outputs])


def _target(problem: Problem) -> Array:
    return np.array([problem.target.get(name, 0.0) for name in problem.outputs])
