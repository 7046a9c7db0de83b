"""The peak of a power that falls like a Gaussian to all sides: a parabola through its logarithm, axis by axis."""

from __future__ import annotations

import math
from collections.abc import Generator, Mapping
from dataclasses import dataclass

from pico.optimize.extremum import same
from pico.optimize.problem import Declaration, Point, Problem, Short, Variable, noise_of
from pico.optimize.stepwise import Result, Steps, Stepwise

DECLARATION = Declaration(
    what="a parabola through the logarithm of a power, axis by axis",
    aims=("maximize",), variables=(1, 4), parameters={"step": 0.15, "left": 0.005, "rounds": 6}, usual=20,
)  # fmt: skip
"""`step`: the first of an axis, as a share of how far the best value is likely to be; `left`: it stops where a round
gains no more than that share of the power; `rounds`: of all axes, at most."""
_SMALLEST = 1e-4
_FURTHEST = 3.0
_WIDER = 3.0


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    return Stepwise(problem, _steps(problem, parameters))


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    output = problem.outputs[0]
    here = yield problem.start
    if _height(here, output) == -math.inf:
        return Short("it is dark where it began")
    steps = {v.name: parameters["step"] * v.likely for v in problem.variables}
    for number in range(int(parameters["rounds"])):
        before, flat = _height(here, output), list[str]()
        for variable in problem.variables:
            found = yield from _line(problem, variable, here, steps[variable.name])
            here, steps[variable.name] = found.best, found.step
            flat += [variable.name] if found.flat else []
        noise = noise_of(here, output) / here[output]
        gained = _height(here, output) - before
        if number and (gained <= max(parameters["left"], 1.5 * noise) or len(problem.variables) == 1):
            idle = f"; by {' and '.join(flat)} it changes by no more than its noise" if flat else ""
            return f"there is no more power to be gained{idle}"
    return Short("all rounds were done")


def _height(result: Result, output: str) -> float:
    value = result.get(output, math.nan)
    return math.log(value) if math.isfinite(value) and value > 0 else -math.inf


@dataclass(frozen=True)
class _Line:
    """What a search along one axis found: the best result, the step that suits the width of the peak, and whether
    nothing changed by more than its noise, however far it went."""

    best: Result
    step: float
    flat: bool


def _line(problem: Problem, variable: Variable, here: Result, step: float) -> Generator[Point, Result, _Line]:
    """Search one axis, by a parabola through three readings; where these are the same but for noise, further apart."""
    name, output = variable.name, problem.outputs[0]
    at = {v.name: here[v.name] for v in problem.variables}
    line = {here[name]: here}
    side = 1.0 if here[name] + step <= variable.high else -1.0
    tries = 0
    while len(line) < 3 and tries < 6:
        tries += 1
        best = max(line.values(), key=lambda r: _height(r, output))
        result = yield {**at, name: best[name] + side * step}
        if _height(result, output) == -math.inf:
            side, step = -side, step / 2 if len(line) > 1 or tries > 1 else step
            continue
        line[result[name]] = result
        if _height(result, output) < _height(best, output):
            side = -side
    while len(line) >= 3 and same(problem, list(line.values())) and step < variable.span:
        step *= _WIDER
        for further in (here[name] + step, here[name] - step):
            result = yield {**at, name: further}
            if _height(result, output) > -math.inf:
                line[result[name]] = result
    best = max(line.values(), key=lambda r: _height(r, output))
    flat = same(problem, list(line.values()))
    if len(line) < 3 or flat:
        return _Line(here if flat else best, max(min(step, variable.span / 4), _SMALLEST * variable.span), flat)
    goal, width = _vertex(_around(line, best[name], output), best[name], step)
    goal = variable.within(goal)
    if abs(goal - best[name]) > 0.15 * step:
        result = yield {**at, name: goal}
        if _height(result, output) > _height(best, output):
            best = result
    return _Line(best, min(max(0.35 * width, _SMALLEST * variable.span), variable.span / 4), False)


def _around(line: Mapping[float, Result], best: float, output: str) -> list[tuple[float, float]]:
    """Return the best place of a line and its neighbours, with the logarithms of the power there: three."""
    places = sorted((x, _height(r, output)) for x, r in line.items())
    first = min(max([x for x, _ in places].index(best) - 1, 0), len(places) - 3)
    return places[first : first + 3]


def _vertex(line: list[tuple[float, float]], best: float, step: float) -> tuple[float, float]:
    """Return the top of the parabola through three points, no further than three steps from the best, and how far from
    it the power has fallen to 1/e."""
    (x0, y0), (x1, y1), (x2, y2) = line
    first, second = (y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1)
    bend = (second - first) / (x2 - x0)
    if bend >= -1e-12:
        return best + math.copysign(_FURTHEST * step, line[-1][1] - line[0][1]), 4 * step
    top = (x0 + x1) / 2 - first / (2 * bend)
    return min(best + _FURTHEST * step, max(best - _FURTHEST * step, top)), 1 / math.sqrt(-bend)
