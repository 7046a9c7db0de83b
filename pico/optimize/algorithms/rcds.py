"""Robust conjugate direction search: Powell's directions, each line searched by a parabola through noisy readings.

X. Huang, J. Corbett, J. Safranek, J. Wu, Nucl. Instrum. Methods A 726, 77 (2013).
"""

from __future__ import annotations

from collections.abc import Generator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pico.optimize.problem import Declaration, Point, Problem, Short
from pico.optimize.stepwise import Result, Steps, Stepwise

DECLARATION = Declaration(
    what="conjugate directions, whose line searches know the noise",
    aims=("reach", "minimize", "maximize"), variables=(1, 8), outputs=(1, 8),
    parameters={"step": 0.1, "rounds": 8}, usual=60,
)  # fmt: skip
"""`step`: the first of a line search, as a share of the range; `rounds`: times that all directions are searched."""
_GOLDEN = 1.618
_REACH = 3.0
Array = NDArray[np.float64]
Search = Generator[Point, Result, Any]


class _Met(Exception):
    """The goal is reached."""


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    return Stepwise(problem, _steps(problem, parameters))


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    try:
        return (yield from _searched(problem, parameters))
    except _Met:
        return "the goal is reached"


def _searched(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    count = len(problem.variables)
    low = np.array([v.low for v in problem.variables])
    span = np.array([v.span for v in problem.variables])

    def tried(at: Array) -> Search:
        point = problem.within({v.name: float(x) for v, x in zip(problem.variables, low + at * span, strict=True)})
        result = yield point
        if problem.met(result):
            raise _Met
        return problem.cost(result), problem.noise(result)

    here = (np.array([v.start for v in problem.variables]) - low) / span
    cost, noise = yield from tried(here)
    directions, step = list(np.eye(count)), parameters["step"]
    for _ in range(int(parameters["rounds"])):
        begun, first, steepest, fall = here, cost, 0, 0.0
        for n, direction in enumerate(directions):
            before = cost
            here, cost, noise = yield from _line(tried, here, cost, noise, direction, step)
            if before - cost > fall:
                steepest, fall = n, before - cost
        if first - cost <= 2 * noise:
            return "a round of searches gained no more than the noise"
        along = here - begun
        size = float(np.linalg.norm(along))
        if count > 1 and size > 1e-9:
            beyond, _ = yield from tried(np.clip(here + along, 0.0, 1.0))
            bend = 2 * (first - 2 * cost + beyond) * (first - cost - fall) ** 2
            if beyond < first and bend < (first - beyond) ** 2 * fall:
                here, cost, noise = yield from _line(tried, here, cost, noise, along / size, step)
                directions = [*directions[:steepest], *directions[steepest + 1 :], along / size]
        step = max(step / 2, 1e-3)
    return Short("all rounds were searched")


def _line(tried: Any, here: Array, cost: float, noise: float, direction: Array, step: float) -> Search:
    """Bracket the least along a direction, by steps that grow until the cost has risen by three standard deviations on
    either side, fit a parabola, and go to its least; return place, cost and noise there."""
    seen = [(0.0, cost)]
    for side in (1.0, -1.0):
        reach = step
        while True:
            at = here + side * reach * direction
            if ((at < 0) | (at > 1)).any():
                break
            there, own = yield from tried(at)
            seen.append((side * reach, there))
            noise = own or noise
            if not np.isfinite(there) or there > min(c for _, c in seen) + max(_REACH * noise, 1e-12):
                break
            reach *= 1 + _GOLDEN
    ways, costs = (np.array(column) for column in zip(*sorted(seen), strict=True))
    good = np.isfinite(costs)
    best = float(ways[good][int(costs[good].argmin())]) if good.any() else 0.0
    if good.sum() >= 3:
        c, b, _ = np.polyfit(ways[good], costs[good], 2)
        if c > 0:
            goal = float(np.clip(-b / (2 * c), ways[good].min(), ways[good].max()))
            if min(abs(goal - w) for w in ways) > 1e-6:
                there, own = yield from tried(here + goal * direction)
                if there <= float(costs[good].min()) + own:
                    return here + goal * direction, there, own or noise
    return here + best * direction, float(costs[good].min()) if good.any() else cost, noise
