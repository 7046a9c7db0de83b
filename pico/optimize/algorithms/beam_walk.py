"""Mirrors that bring a beam through places at once, by the power behind them.

The logarithm of the power is a parabola, log P = c - (X / w)^2 - (Y / w)^2 - (U / v)^2 - (V / v)^2, in the offsets X, Y
at a near place (or of a fibre) and U, V at a far one (or the angles). How far each tunable moves the beam is known
nominally, so that only the middle and c are left to be fitted, by Gauss and Newton: five numbers for two mirrors.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pico.diagnostics import PicoError, error
from pico.optimize.problem import Declaration, Problem
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
        return "it is dark where it began"
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
    expected = -math.inf
    for _ in range(_MOST):
        goal, peak = _fitted(names, output, seen, shape)
        best = max(seen, key=lambda r: r[output])
        at = np.array([best[n] for n in names])
        step = goal - at
        drop = float(step @ shape @ step)
        noise = best.get(f"{output}_sigma", 0.0) / best[output]
        if (
            len(seen) > len(names) + 1
            and drop <= parameters["left"] + noise
            and peak - math.log(best[output]) <= 0.03 + 2 * noise
        ):
            return "there is no more power to be gained"
        reach = min(1.0, math.sqrt(_FAR / drop)) if drop > 0 else 1.0
        result = yield dict(zip(names, (at + reach * step).tolist(), strict=True))
        if _bright(result, output):
            seen.append(result)
        else:  # too far: half the way
            result = yield dict(zip(names, (at + reach * step / 3).tolist(), strict=True))
            if not _bright(result, output):
                return "the light is lost on the way to more"
            seen.append(result)
        gained = math.log(result[output]) - math.log(best[output])
        if expected > -math.inf and abs(gained) <= 2 * noise and drop <= 5 * parameters["left"]:
            return "there is no more power to be gained"
        expected = gained
    return "it comes no nearer"


def _bright(result: Result, output: str) -> bool:
    value = result.get(output, math.nan)
    return math.isfinite(value) and value > 3 * result.get(f"{output}_sigma", 0.0) and value > 0


def _fitted(names: list[str], output: str, seen: list[Result], shape: Array) -> tuple[Array, float]:
    """Return the middle (4,) and the logarithm of the power there: log P + u' H u = c' + g . u, in the least squares,
    what is near the brightest counting most."""
    power = np.array([r[output] for r in seen])
    u = np.array([[r[n] for n in names] for r in seen])
    best = u[int(power.argmax())]
    away = u - best
    height = np.log(power) + np.einsum("ni,ij,nj->n", away, shape, away)
    away_by = np.einsum("ni,ij,nj->n", away, shape, away)
    sigma = np.array([max(r.get(f"{output}_sigma", 0.0) / r[output], 2e-3) for r in seen])
    weight = 1 / np.hypot(sigma, 0.05 * away_by)  # arms are nominal
    scale = 1 / np.sqrt(np.maximum(np.diag(shape), 1e-12))
    rows = np.column_stack([np.ones(len(seen)), away * scale]) * weight[:, None]
    found = np.linalg.lstsq(rows, height * weight, rcond=1e-9)[0]
    gradient = found[1:] * scale
    middle = np.linalg.lstsq(2 * shape, gradient, rcond=1e-9)[0]
    return best + middle, float(found[0] + middle @ shape @ middle)
