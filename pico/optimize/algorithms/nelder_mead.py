"""The simplex of Nelder and Mead (Comput. J. 7, 308 (1965)), which stops where it cannot tell its corners apart."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from pico.optimize.problem import Declaration, Point, Problem
from pico.optimize.stepwise import Result, Steps, Stepwise

Array = NDArray[np.float64]
DECLARATION = Declaration(
    what="a simplex that needs no model and no gradient",
    aims=("reach", "minimize", "maximize"), variables=(1, 8), outputs=(1, 8),
    parameters={"step": 0.5, "within": 0.0}, usual=40,
)  # fmt: skip
"""`step`: the first simplex, as a share of how far the best point is likely to be; `within`: it stops where it is
smaller than that share of the range, or, with 0, where its corners differ by no more than their noise."""
_SMALLEST = 1e-4
_WIDEST = 0.4  # of the range: a whole period further on it would stand where it began
Trying: TypeAlias = Callable[[Array], "Generator[Point, Result, _Corner]"]


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    return Stepwise(problem, _steps(problem, parameters))


class _Met(Exception):
    """The goal is reached."""


@dataclass(frozen=True)
class _Corner:
    """A corner of the simplex, in shares of the ranges: its place, cost, and the noise of that."""

    at: Array
    cost: float
    noise: float


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    try:
        return (yield from _climbed(problem, parameters))
    except _Met:
        return "the goal is reached"


def _climbed(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    span, low = (np.array([getattr(v, name) for v in problem.variables]) for name in ("span", "low"))

    def tried(at: Array) -> Generator[Point, Result, _Corner]:
        point = problem.within({v.name: float(x) for v, x in zip(problem.variables, low + at * span, strict=True)})
        result = yield point
        if problem.met(result):
            raise _Met
        there = (np.array([point[v.name] for v in problem.variables]) - low) / span
        return _Corner(there, problem.cost(result), problem.noise(result))

    begun = (np.array([v.start for v in problem.variables]) - low) / span
    corners = []
    for at in _simplex(problem, begun, parameters["step"]):
        corners.append((yield from tried(at)))
    while True:
        corners.sort(key=lambda c: c.cost)
        if why := _small(corners, parameters["within"]):
            return why
        corners = yield from _turned_over(corners, tried)


def _simplex(problem: Problem, begun: Array, step: float) -> Iterator[Array]:
    """Yield the first corners: where it stands, and a step along each axis."""
    yield begun
    for n, variable in enumerate(problem.variables):
        move = min(step * variable.likely / variable.span, _WIDEST)
        corner = begun.copy()
        corner[n] += move if begun[n] + move <= 1 else -move
        yield corner


def _small(corners: Sequence[_Corner], within: float) -> str:
    """Return why a simplex, best corner first, is small enough; empty where it is not."""
    if max(float(np.abs(c.at - corners[0].at).max()) for c in corners[1:]) < max(within, _SMALLEST):
        return "the simplex is small"
    noise = max(c.noise for c in corners)
    if not within and noise > 0 and corners[-1].cost - corners[0].cost <= 2 * noise:
        return "the corners of the simplex differ by no more than their noise"
    return ""


def _turned_over(corners: list[_Corner], tried: Trying) -> Generator[Point, Result, list[_Corner]]:
    """Return the next simplex of one whose best corner comes first."""
    best, worst, others = corners[0], corners[-1], corners[:-1]
    middle = np.mean([c.at for c in others], axis=0)
    one = yield from tried(middle + (middle - worst.at))
    if one.cost < best.cost:
        two = yield from tried(middle + 2 * (middle - worst.at))
        return [*others, two if two.cost < one.cost else one]
    if one.cost < others[-1].cost:
        return [*others, one]
    outside = one.cost < worst.cost
    two = yield from tried(middle + (0.5 if outside else -0.5) * (middle - worst.at))
    if two.cost < min(one.cost, worst.cost):
        return [*others, two]
    shrunk = [best]
    for corner in corners[1:]:
        shrunk.append((yield from tried(best.at + 0.5 * (corner.at - best.at))))
    return shrunk
