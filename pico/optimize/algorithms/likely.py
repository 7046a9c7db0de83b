"""Places in the order in which light is likely to be there, by how well parts are put down, until it is seen.

In coordinates v in which the logarithm of the power falls by v'v from its best, light is seen within a ball whose
radius is the square root of the depth. Balls are laid over all along which the best may be further off than that, and
tried from the likeliest on.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from pico.diagnostics import PicoError, error
from pico.optimize.problem import Declaration, Nominal, Problem
from pico.optimize.search import bright
from pico.optimize.stepwise import Steps, Stepwise

DECLARATION = Declaration(
    what="places in the order in which light is likely to be there, until it is seen",
    aims=("reach", "minimize", "maximize"), variables=(1, 6), outputs=(1, 12),
    parameters={"sigmas": 3.5, "overlap": 0.85, "most": 400.0}, usual=20,
)  # fmt: skip
"""`sigmas`: standard deviations of a placement to which it is searched; `overlap`: how close places are, as a share of
what would just leave no gap; `most`: places."""
_SURELY = 0.5
"""Radii within which the best is along a way that is not searched, at so many standard deviations as are searched."""
_WIDEST = 0.5
Array = NDArray[np.float64]


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem; raises PicoError where nobody says how likely light is where."""
    if problem.nominal is None:
        text = "nobody can say where light is likely to be: the nominal beam does not come to where it is measured"
        raise PicoError(error("algorithm", text, hint="`spiral` looks around where it is"))
    return Stepwise(problem, _steps(problem, problem.nominal, parameters))


def _steps(problem: Problem, nominal: Nominal, parameters: Mapping[str, float]) -> Steps:
    names = [v.name for v in problem.variables]
    here, tried = np.array([v.start for v in problem.variables]), 0
    here += np.array(nominal.shift) if nominal.shift else 0.0
    for move in _moves(nominal, parameters["sigmas"], parameters["overlap"]):
        point = dict(zip(names, (here + move).tolist(), strict=True))
        if tried >= parameters["most"]:
            break
        if any(not v.low <= point[v.name] <= v.high for v in problem.variables):
            continue
        tried += 1
        result = yield point
        if bright(problem, result, 0.0):
            return "there is light"
    return f"it is dark at {tried} place{'s' if tried != 1 else ''}"


def _moves(nominal: Nominal, sigmas: float, overlap: float) -> Iterator[Array]:
    """Yield moves from where the tunables stand, the likeliest first, that itself the first."""
    values, vectors = np.linalg.eigh(np.array(nominal.shape))
    values = np.maximum(values, 1e-9 * values.max())
    back = vectors / np.sqrt(values)  # u = back v
    into = np.sqrt(values)[:, None] * vectors.T
    squares, ways = np.linalg.eigh(into @ np.array(nominal.spread) @ into.T)
    far = np.sqrt(np.maximum(squares, 0.0))
    radius = math.sqrt(nominal.depth)
    wide = [n for n in np.argsort(far)[::-1] if sigmas * far[n] > _SURELY * radius]
    known = sum(float(far[n]) ** 2 for n in range(len(far)) if n not in wide)
    ball = math.sqrt(max(nominal.depth - known, _WIDEST**2 * nominal.depth))
    for place in _lattice([float(far[n]) for n in wide], sigmas, ball * overlap):
        yield back @ (ways[:, wide] @ np.array(place)) if wide else np.zeros(len(far))


def _lattice(far: list[float], sigmas: float, ball: float) -> list[tuple[float, ...]]:
    """Return the middles of balls that cover an ellipsoid of half axes `sigmas` times `far`, the likeliest first:
    triangles where it is flat, cubes where not."""
    if not far:
        return [()]
    many = len(far)
    pitch = ball * math.sqrt(3) if many == 2 else 2 * ball / math.sqrt(many)
    steps = [pitch, *([pitch * math.sqrt(3) / 2] if many == 2 else [pitch] * (many - 1))]
    ranges = [range(-n, n + 1) for n in (math.ceil(sigmas * f / s) for f, s in zip(far, steps, strict=True))]
    found = []
    for cell in itertools.product(*ranges):
        shift = pitch / 2 if many == 2 and cell[1] % 2 else 0.0
        place = tuple(n * s + (shift if not axis else 0.0) for axis, (n, s) in enumerate(zip(cell, steps, strict=True)))
        # as near as a ball around it comes to the middle
        size = math.hypot(*place)
        inward = max(0.0, 1 - ball / size) if size else 0.0
        if math.hypot(*(inward * x / f for x, f in zip(place, far, strict=True))) <= sigmas:
            found.append(place)
    return sorted(found, key=lambda p: math.hypot(*(x / f for x, f in zip(p, far, strict=True))))
