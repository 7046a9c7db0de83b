"""The null or the peak of a polarizer or a wave plate: y = a - b cos(k x) - c sin(k x), in k of one period.

Two readings tell where it may be if the floor is 0; the third is taken there, and each next where it tells most about
the place of the extremum, by the noise of the readings.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pico.optimize.problem import Declaration, Problem, Solution, Variable
from pico.optimize.stepwise import Result, Steps, Stepwise

DECLARATION = Declaration(
    what="the law of Malus, fitted to a few readings",
    aims=("minimize", "maximize"), variables=(1, 1),
    parameters={"cycle": 180.0, "within": 0.1}, usual=5, solves=True,
)  # fmt: skip
"""`cycle`: after which readings repeat (180 deg of a polarizer, 90 of a half-wave plate); `within`: how well the place
is to be known, in the tunable's unit."""
_MOST = 20
_ANYWHERE = (0.0, 1 / 2, 1 / 4, 3 / 4, 1 / 8, 5 / 8, 3 / 8, 7 / 8)
"""Where the first reading is sought, in cycles from where it stands: where it is too dark or too bright to be read, it
is neither half a cycle farther."""
_NEARBY = (1 / 4, 1 / 8, 1 / 16, 1 / 32, 1 / 64)
"""Where the second is sought, from the first one."""
_NOISE = 0.005
_FLOOR = 1e-6
_AGREES, _SHARE = 8.0, 0.01
"""Standard deviations, and share of the brightest reading, by which a reading may be off the law."""
_FLICKER = 0.002
"""By which share a laser is another from reading to reading, which no standard deviation of one reading tells."""
Array = NDArray[np.float64]


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    return Stepwise(problem, _steps(problem, parameters))


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    variable, output = problem.variables[0], problem.outputs[0]
    k = 2 * math.pi / parameters["cycle"]
    seen: list[Result] = []
    for probes in (_ANYWHERE, _NEARBY):
        base = seen[0][variable.name] if seen else variable.start
        for share in probes:
            result = yield {variable.name: _from(variable, base, share * parameters["cycle"])}
            if problem.measured(result):
                seen.append(result)
                break
        else:
            return f"there is too little to see: {len(seen)} readings of {variable.name}"
    for _ in range(_MOST):
        if len(seen) == 2:
            at = _guess(problem, variable, output, seen, k)
        else:
            place, sigma, fit = _fitted(problem, variable, output, seen, k)
            if sigma <= parameters["within"] / 3:
                last = yield {variable.name: place}
                seen += [last] if problem.measured(last) else []
                if problem.measured(last) and _agrees(variable, output, seen, k, fit):
                    place, sigma, _ = _fitted(problem, variable, output, seen, k)
                    return "the place of the extremum is known", Solution(
                        {variable.name: place}, {variable.name: sigma}
                    )
            at = _telling(problem, variable, output, seen, k, fit)
        result = yield {variable.name: at}
        seen += [result] if problem.measured(result) else []
    return "the readings do not follow the law of Malus well enough"


def _from(variable: Variable, base: float, away: float) -> float:
    """Return the value that is so far from another one; on its other side where the bounds end before, and nothing
    comes round."""
    return variable.within(base + away if variable.period or base + away <= variable.high else base - away)


def _guess(problem: Problem, variable: Variable, output: str, seen: list[Result], k: float) -> float:
    """Return where the extremum is if the floor is 0: of the two places that two readings leave, the one that is nearer
    to where it began."""
    (x1, y1), (x2, y2) = ((r[variable.name], max(r[output], 0.0)) for r in seen)
    ratio = math.sqrt(y1 / y2) if y2 > 0 else 1e6
    turn = k * (x2 - x1) / 2
    places = []
    for sign in (1, -1):
        # y ~ sin(u)^2, u = k (x - x0) / 2: sin u1 = sign ratio sin(u1 + turn)
        u = math.atan2(sign * ratio * math.sin(turn), 1 - sign * ratio * math.cos(turn))
        null = x1 - 2 * u / k
        places.append(null if problem.aim == "minimize" else null + math.pi / k)
    cycle = 2 * math.pi / k
    near = [variable.start + (p - variable.start + cycle / 2) % cycle - cycle / 2 for p in places]
    return variable.within(min(near, key=lambda p: abs(p - variable.start)))


def _scaled(variable: Variable, output: str, seen: list[Result]) -> tuple[Array, Array, Array]:
    """Return where it was read, what was read, and the standard deviations, in shares of the largest reading."""
    most = max(abs(r[output]) for r in seen) or 1.0
    share = [abs(r[output]) / most for r in seen]
    sigma = [
        max(math.hypot(s / most, _FLICKER * y) if (s := r.get(f"{output}_sigma", 0.0)) else _NOISE * y, _FLOOR)
        for r, y in zip(seen, share, strict=True)
    ]
    return np.array([r[variable.name] for r in seen]), np.array([r[output] / most for r in seen]), np.array(sigma)


def _fitted(
    problem: Problem, variable: Variable, output: str, seen: list[Result], k: float
) -> tuple[float, float, Array]:
    """Return the place of the extremum, its standard deviation, and the three coefficients."""
    x, y, sigma = _scaled(variable, output, seen)
    rows = _rows(x, k) / sigma[:, None]
    normal = rows.T @ rows
    covariance = np.linalg.pinv(normal, hermitian=True, rcond=1e-14)
    fit = covariance @ (rows.T @ (y / sigma))
    return _place(problem, variable, fit, k), _spread(fit, covariance, k), fit


def _rows(x: Array, k: float) -> Array:
    return np.stack([np.ones_like(x), -np.cos(k * x), -np.sin(k * x)], axis=-1)


def _place(problem: Problem, variable: Variable, fit: Array, k: float) -> float:
    null = math.atan2(fit[2], fit[1]) / k  # where cos(kx - that) is 1: the least
    if problem.aim == "maximize":
        null += math.pi / k
    cycle = 2 * math.pi / k
    return variable.within(variable.start + (null - variable.start + cycle / 2) % cycle - cycle / 2)


def _agrees(variable: Variable, output: str, seen: list[Result], k: float, fit: Array) -> bool:
    """Whether what was read last is what the readings before it had said."""
    x, y, sigma = _scaled(variable, output, seen)
    most, before = (max(abs(r[output]) for r in some) or 1.0 for some in (seen, seen[:-1]))
    expected = float(_rows(x[-1:], k)[0] @ fit) * before / most
    return abs(float(y[-1]) - expected) <= max(_AGREES * float(sigma[-1]), _SHARE)


def _spread(fit: Array, covariance: NDArray[np.floating], k: float) -> float:
    size = float(fit[1] ** 2 + fit[2] ** 2)
    if size == 0:
        return math.inf
    slope = np.array([0.0, -fit[2], fit[1]]) / size / k
    return math.sqrt(max(0.0, float(slope @ covariance @ slope)))


def _telling(problem: Problem, variable: Variable, output: str, seen: list[Result], k: float, fit: Array) -> float:
    """Return the value at which a reading will tell most about the place of the extremum."""
    x, y, sigma = _scaled(variable, output, seen)
    share = float(np.median(sigma / np.maximum(np.abs(y), _FLOOR)))
    rows = _rows(x, k) / sigma[:, None]
    normal = rows.T @ rows
    place, cycle = _place(problem, variable, fit, k), 2 * math.pi / k
    best = (math.inf, place)
    for away in np.linspace(-0.25, 0.25, 81) * cycle:
        at = variable.within(place + float(away))
        row = _rows(np.array([at]), k)[0]
        expected = max(abs(float(row @ fit)), _FLOOR)
        noise = max(share * expected, float(sigma.min()))
        there = np.linalg.pinv(normal + np.outer(row, row) / noise**2, hermitian=True, rcond=1e-14)
        best = min(best, (_spread(fit, there, k), at))
    return best[1]
