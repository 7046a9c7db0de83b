"""Mirrors that bring a beam through places at once, by the power behind them.

The logarithm of the power is a parabola, log P = c - (X / w)^2 - (Y / w)^2 - (U / v)^2 - (V / v)^2, in the offsets X, Y
at a near place (or of a fiber) and U, V at a far one (or the angles). How far each tunable moves the beam is known
nominally, so that only the middle and c are left to be fitted, by Gauss and Newton: five numbers for two mirrors.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.diagnostics import PicoError, error
from pico.optimize.problem import Declaration, Problem, Short, noise_of
from pico.optimize.stepwise import Result, Steps, Stepwise

DECLARATION = Declaration(
    what="Gauss-Newton on the logarithm of the power, with the nominal arms between mirrors and targets",
    aims=("maximize",), variables=(1, 6),
    parameters={
        "near_1": 1.2, "near_2": 0.6, "far_1": 0.002, "far_2": 0.002, "near_width": 0.5, "far_width": 0.0004,
        "probe": 0.45, "left": 0.012,
    }, usual=9,
)  # fmt: skip
"""Where the nominal beam tells how the power falls, that counts; else arms and widths do, and the tunables are tip and
tilt of the first mirror, tip and tilt of the second. `near_1`: by how much one unit of the
first mirror moves the beam at the near place [mm], and so on; `far`: at the far place [mm], or turns it [rad]. Widths:
offsets [same] at which the power has fallen to 1/e. `probe`: first steps, in the length at which the power falls to
1/e; `left`: it stops where no more than that share of the power is to be gained."""
_MOST = 60
_ARMS = 0.03
"""By which share the power may fall otherwise than arms and widths, which are nominal, have it."""
_UNSURE = 0.03
"""The share of the power by which there may be less at the middle, as badly as that is known, until it is read beside
it, too."""
_FAR = 6.0  # of log P: how far below the brightest a reading tells little
Array = NDArray[np.float64]


def make(problem: Problem, parameters: Mapping[str, float], seed: int) -> Stepwise:
    """Return the algorithm for a problem; raises PicoError where nobody says how its tunables move the beam."""
    if problem.nominal is None and len(problem.variables) != 4:
        text = "beam_walk can't tell how the tunables move the beam: none comes nominally to where it is measured"
        raise PicoError(error("algorithm", text, hint="`peak` needs to know nothing; two mirrors can have their arms"))
    return Stepwise(problem, _steps(problem, parameters))


def _shape(problem: Problem, parameters: Mapping[str, float]) -> Array:
    """Return H (n, n) of log P = c - u' H u."""
    if problem.nominal is not None:
        return np.array(problem.nominal.shape)
    near = np.array([parameters["near_1"], parameters["near_2"]]) / parameters["near_width"]
    far = np.array([parameters["far_1"], parameters["far_2"]]) / parameters["far_width"]
    plane = np.outer(near, near) + np.outer(far, far)
    whole = np.zeros((4, 4))
    for axis in (0, 1):
        index = [axis, axis + 2]
        whole[np.ix_(index, index)] = plane
    return whole


def _steps(problem: Problem, parameters: Mapping[str, float]) -> Steps:
    names, output = [v.name for v in problem.variables], problem.outputs[0]
    shape = _shape(problem, parameters)
    first = yield problem.start
    if not _bright(first, output):
        return Short("it is dark where it began")
    seen = [first]
    # along the ways that change the power most for their length, both planes at once
    values, vectors = np.linalg.eigh(shape)
    here = np.array([first[n] for n in names])
    for n in np.argsort(values)[::-1]:
        step, sign = parameters["probe"] / math.sqrt(max(values[n], 1e-12)) * vectors[:, n], 1.0
        reach = min(1.0, *(v.span / 4 / abs(s) if s else 1.0 for v, s in zip(problem.variables, step, strict=True)))
        for _ in range(3):
            result = yield dict(zip(names, (here + sign * reach * step).tolist(), strict=True))
            if _bright(result, output):
                seen.append(result)
                break
            sign, reach = -sign, reach / 2
        if _bright(result, output) and result[output] > max(r[output] for r in seen[:-1]):
            here = np.array([result[n] for n in names])
    back, vain = _back(shape), 0
    for _ in range(_MOST):
        fit, best = _fitted(names, output, seen, shape), max(seen, key=lambda r: r[output])
        at, goal = np.array([best[n] for n in names]), _within(problem, fit.middle, back)
        step, short = goal - at, goal - fit.middle
        drop, most = float(step @ shape @ step), fit.peak - float(short @ shape @ short)
        noise, unsure = noise_of(best, output) / best[output], float(np.trace(fit.unsure)) > _UNSURE
        there = drop <= parameters["left"] + noise
        if there and not unsure and most - math.log(best[output]) <= 0.03 + 2 * noise:
            return "there is no more power to be gained"
        step = step * min(1.0, math.sqrt(_FAR / drop)) if drop > 0 else step
        if there and unsure:  # beside it, where that tells most
            step = step + parameters["probe"] * back @ np.linalg.eigh(fit.unsure)[1][:, -1]
        result = yield dict(zip(names, (at + step).tolist(), strict=True))
        if not _bright(result, output):  # too far: a third of the way
            result = yield dict(zip(names, (at + step / 3).tolist(), strict=True))
            if not _bright(result, output):
                return Short("the light is lost on the way to more")
        seen.append(result)
        gained = math.log(result[output]) - math.log(best[output])
        vain = vain + 1 if not unsure and abs(gained) <= 2 * noise else 0
        if vain and (vain > 1 or drop <= 5 * parameters["left"]):  # flatter at its top than it is thought to be
            return "there is no more power to be gained"
    return Short("it comes no nearer")


@dataclass(frozen=True)
class _Fit:
    """Where the power is highest (n,), its logarithm there, and how far off that may be: a covariance (n, n) in units
    in which the logarithm falls by the square, so that its trace is by how much less there may be."""

    middle: Array
    peak: float
    unsure: Array


def _bright(result: Result, output: str) -> bool:
    value = result.get(output, math.nan)
    return math.isfinite(value) and value > 3 * noise_of(result, output) and value > 0


def _back(shape: Array) -> Array:
    """Return B (n, n) of u = B v, in whose v the logarithm of the power falls by v'v: the root of the inverse of H."""
    values, vectors = np.linalg.eigh(shape)
    return np.asarray(vectors / np.sqrt(np.maximum(values, 1e-9 * values[-1])))


def _within(problem: Problem, middle: Array, back: Array) -> Array:
    """Return where within the bounds the power falls least from its middle."""
    low, high = (np.array([getattr(v, end) for v in problem.variables]) for end in ("low", "high"))
    if ((low <= middle) & (middle <= high)).all():
        return middle
    from scipy.optimize import lsq_linear

    into = np.linalg.inv(back)
    return np.asarray(np.clip(lsq_linear(into, into @ middle, (low, high)).x, low, high))


def _fitted(names: list[str], output: str, seen: list[Result], shape: Array) -> _Fit:
    """Return the middle and the logarithm of the power there: log P + u' H u = c' + g . u, in the least squares, what
    is near the brightest counting most. g . u is 2 m . v, with m the middle."""
    power = np.array([r[output] for r in seen])
    u = np.array([[r[n] for n in names] for r in seen])
    best = u[int(power.argmax())]
    away = u - best
    height = np.log(power) + np.einsum("ni,ij,nj->n", away, shape, away)
    away_by = np.einsum("ni,ij,nj->n", away, shape, away)
    sigma = np.array([max(noise_of(r, output) / r[output], 2e-3) for r in seen])
    weight = 1 / np.hypot(sigma, _ARMS * away_by)
    back = _back(shape)
    rows = np.column_stack([np.ones(len(seen)), 2 * away @ np.linalg.inv(back).T]) * weight[:, None]
    normal = np.linalg.pinv(rows.T @ rows, hermitian=True, rcond=1e-12)
    found = np.linalg.lstsq(rows, height * weight, rcond=1e-9)[0]
    return _Fit(best + back @ found[1:], float(found[0] + found[1:] @ found[1:]), normal[1:, 1:])
