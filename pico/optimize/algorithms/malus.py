"""The null or the peak of a polarizer or a wave plate: y = a - b cos(k x) - c sin(k x), in k of one period.

Two readings tell where it may be if the floor is 0; the third is taken there, and each next where it tells most about
the place of the extremum, by the noise of the readings. What is read at the extremum must be what the others had said.
Where it is not, other parts have a law of their own (a polarizer between polarizers): then a reading counts the less
the farther it is from the extremum, near which each law is this one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.optimize.extremum import FLICKER
from pico.optimize.problem import Declaration, Problem, Short, Solution, Variable, noise_of
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
_AGREES = 8.0
"""Standard deviations by which a reading may be off what the readings before it say."""
_DOUBT = 3.0
"""By which share of itself a reading may be off the law, for each radian that it is from the extremum, where the law is
not all: another polarizer at 45 deg makes 2 of it."""
_DARKER, _SAFE = 0.03, 0.8
"""By which share less noise than in the dimmest reading is hoped for where it is dimmer still; which share of what was
too bright is not."""
_TIMES, _CLOSE = 6.0, 0.01
"""How far beside a null that is known too badly readings are taken: in standard deviations, and at least in cycles."""
_AGAIN = 4
"""How often the extremum is sought anew, each time with the doubt that the last one leaves."""
_AWAY = np.concatenate([s * np.geomspace(0.25, 0.001, 40) for s in (1, -1)])
"""How far from the extremum readings may tell of it, in cycles."""
Array = NDArray[np.float64]


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem."""
    return Stepwise(problem, _steps(problem, parameters))


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    variable, output = problem.variables[0], problem.outputs[0]
    k = 2 * math.pi / parameters["cycle"]
    seen: list[Result] = []
    unread: list[float] = []
    for third in (False, False, True):
        for at in _third(problem, variable, output, seen, k) if third else _probes(variable, seen, parameters["cycle"]):
            result = yield {variable.name: at}
            if problem.measured(result):
                seen.append(result)
                break
            unread.append(at)
        else:
            return Short(f"there is too little to see: {len(seen)} readings of {variable.name}")
    doubt = 0.0
    for _ in range(_MOST):
        fit = _fitted(problem, variable, output, seen, k, doubt)
        known = fit.known <= parameters["within"] / 3
        told, at = (fit.known, fit.place) if known else _telling(problem, variable, output, seen, unread, k, fit)
        if problem.aim == "minimize" and (told > parameters["within"] / 3 or (doubt and not known)):
            at = _beside(variable, seen, unread, fit.place, _near(parameters, fit.known, k, doubt))
        result = yield {variable.name: at}
        if not problem.measured(result):
            unread.append(at)
            continue
        seen.append(result)
        if known and _agrees(variable, output, seen, k, fit):
            fit = _fitted(problem, variable, output, seen, k, doubt)
            found = Solution({variable.name: fit.place}, {variable.name: fit.known})
            return "the place of the extremum is known", found
        doubt = _DOUBT if known else doubt
    return Short("the readings do not follow the law of Malus well enough")


def _probes(variable: Variable, seen: list[Result], cycle: float) -> list[float]:
    """Return where the first two readings are sought, one after the other until one is."""
    shares, base = (_NEARBY, seen[0][variable.name]) if seen else (_ANYWHERE, variable.start)
    return [_from(variable, base, share * cycle) for share in shares]


def _third(problem: Problem, variable: Variable, output: str, seen: list[Result], k: float) -> list[float]:
    """Return where the third reading is sought: the two places of the extremum that two readings leave, the nearer
    first; then near the two."""
    x1, x2 = (r[variable.name] for r in seen)
    more = [variable.within(at) for at in ((x1 + x2) / 2, x1 - (x2 - x1) / 2, x2 + (x2 - x1) / 2)]
    return [*_guesses(problem, variable, output, seen, k), *more]


def _from(variable: Variable, base: float, away: float) -> float:
    """Return the value that is so far from another one; on its other side where the bounds end before, and nothing
    comes round."""
    return variable.within(base + away if variable.period or base + away <= variable.high else base - away)


def _guesses(problem: Problem, variable: Variable, output: str, seen: list[Result], k: float) -> list[float]:
    """Return where the extremum is if the floor is 0: the two places that two readings leave, the one that is nearer to
    where it began first."""
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
    return [variable.within(p) for p in sorted(near, key=lambda p: abs(p - variable.start))]


@dataclass(frozen=True)
class _Fit:
    """The place of the extremum with its standard deviation, and the coefficients of the law [share of the largest
    reading] with their covariance; `sigma`: of the readings, in such shares."""

    place: float
    known: float
    law: Array
    covariance: NDArray[np.floating]
    sigma: Array


def _scaled(output: str, variable: Variable, seen: list[Result]) -> tuple[Array, Array, Array]:
    """Return where it was read, what was read, and the standard deviations, in shares of the largest reading."""
    most = max(abs(r[output]) for r in seen) or 1.0
    share = [abs(r[output]) / most for r in seen]
    sigma = [
        max(math.hypot(s / most, FLICKER * y) if (s := noise_of(r, output)) else _NOISE * y, _FLOOR)
        for r, y in zip(seen, share, strict=True)
    ]
    return np.array([r[variable.name] for r in seen]), np.array([r[output] / most for r in seen]), np.array(sigma)


def _fitted(
    problem: Problem, variable: Variable, output: str, seen: list[Result], k: float, doubt: float = 0.0
) -> _Fit:
    """Return the law that fits what was read; `doubt`: of readings far from the extremum, see `_DOUBT`."""
    x, y, sigma = _scaled(output, variable, seen)
    fit = _solved(problem, variable, x, y, sigma, k)
    for _ in range(_AGAIN if doubt else 0):
        off = np.abs(np.sin(k * (x - fit.place) / 2)) ** 3 * 2 * math.hypot(*fit.law[1:])
        fit = _solved(problem, variable, x, y, np.hypot(sigma, doubt * off), k)
    return fit


def _solved(problem: Problem, variable: Variable, x: Array, y: Array, sigma: Array, k: float) -> _Fit:
    rows = _rows(x, k) / sigma[:, None]
    covariance = np.linalg.pinv(rows.T @ rows, hermitian=True, rcond=1e-14)
    law = covariance @ (rows.T @ (y / sigma))
    return _Fit(_place(problem, variable, law, k), _spread(law, covariance, k), law, covariance, sigma)


def _rows(x: Array, k: float) -> Array:
    return np.stack([np.ones_like(x), -np.cos(k * x), -np.sin(k * x)], axis=-1)


def _place(problem: Problem, variable: Variable, law: Array, k: float) -> float:
    null = math.atan2(law[2], law[1]) / k  # where cos(kx - that) is 1: the least
    if problem.aim == "maximize":
        null += math.pi / k
    cycle = 2 * math.pi / k
    return variable.within(variable.start + (null - variable.start + cycle / 2) % cycle - cycle / 2)


def _agrees(variable: Variable, output: str, seen: list[Result], k: float, fit: _Fit) -> bool:
    """Whether what was read last is what the readings before it had said."""
    x, y, sigma = _scaled(output, variable, seen)
    most, before = (max(abs(r[output]) for r in some) or 1.0 for some in (seen, seen[:-1]))
    row = _rows(x[-1:], k)[0]
    expected, doubt = float(row @ fit.law) * before / most, math.sqrt(max(0.0, float(row @ fit.covariance @ row)))
    return abs(float(y[-1]) - expected) <= _AGREES * math.hypot(float(sigma[-1]), doubt * before / most)


def _spread(fit: Array, covariance: NDArray[np.floating], k: float) -> float:
    size = float(fit[1] ** 2 + fit[2] ** 2)
    if size == 0:
        return math.inf
    slope = np.array([0.0, -fit[2], fit[1]]) / size / k
    return math.sqrt(max(0.0, float(slope @ covariance @ slope)))


def _telling(
    problem: Problem, variable: Variable, output: str, seen: list[Result], unread: list[float], k: float, fit: _Fit
) -> tuple[float, float]:
    """Return the value at which a reading will tell most about the place of the extremum, among those that are neither
    too bright nor too dark to be read, as far as `unread` ones tell; and how well the place is known then."""
    x, y, sigma = _scaled(output, variable, seen)
    share = float(np.median(sigma / np.maximum(np.abs(y), _FLOOR)))
    rows, least = _rows(x, k) / fit.sigma[:, None], _floor(y, sigma, share)
    normal = rows.T @ rows
    lowest, highest = _readable(y, [float(_rows(np.array([at]), k)[0] @ fit.law) for at in unread])
    places = np.array([variable.within(fit.place + float(away)) for away in _AWAY * 2 * math.pi / k])
    row = _rows(places, k)
    expected = np.maximum(np.abs(row @ fit.law), _FLOOR)
    noise = np.maximum(share * expected, least)
    more = row[:, :, None] * row[:, None, :] / (noise**2)[:, None, None]
    there = np.linalg.pinv(normal + more, hermitian=True, rcond=1e-14)
    told = [
        _spread(fit.law, one, k) if lowest < y < highest else math.inf for one, y in zip(there, expected, strict=True)
    ]
    best = int(np.argmin(told))
    return told[best], float(places[best])


def _beside(variable: Variable, seen: list[Result], unread: list[float], place: float, away: float) -> float:
    """Return a value so far from a null, on the side of it that has been read less closely: two readings that lie on
    both sides of a null tell of its place without knowing how dark it is."""
    known = [r[variable.name] for r in seen] + unread
    sides = [variable.within(place + away), variable.within(place - away)]
    return max(sides, key=lambda at: min(abs(at - one) for one in known))


def _near(parameters: Mapping[str, float], known: float, k: float, doubt: float) -> float:
    """Return how far beside a null a reading tells of its place: farther the worse that is known, but not where, the
    law being doubted, both sides together would be off by more than is wanted: by u^2, u the angle in radians."""
    away = max(_TIMES * known, _CLOSE * parameters["cycle"])
    return min(away, 2 / k * math.sqrt(parameters["within"] / 3 * k / 2)) if doubt else away


def _floor(y: Array, sigma: Array, share: float) -> float:
    """Return the noise of a reading without light, in shares of the largest reading: that of the dimmest reading where
    its noise is no share of it; else much less, as nobody knows yet."""
    dim = int(np.argmin(np.abs(y)))
    if sigma[dim] > 3 * share * abs(y[dim]):
        return float(sigma[dim])
    return max(_FLOOR * share, _DARKER * share * abs(float(y[dim])))


def _readable(y: Array, unread: list[float]) -> tuple[float, float]:
    """Return between which readings others may be expected to be read, in shares of the largest one: what could not be
    read though it is brighter, or darker, than all that was read."""
    bright = [one for one in unread if one > float(y.max())]
    dark = [one for one in unread if one < float(y.min())]
    return max(dark, default=-math.inf), _SAFE * min(bright, default=math.inf)
