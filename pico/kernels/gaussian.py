"""Least squares of a rotated Gaussian on a background of known slope. Needs numpy at its top: kernels import it inside
their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import binned
from pico.kernels.frame import Frame
from pico.kernels.moments import PIXEL
from pico.kernels.rounding import LIT, rounding
from pico.kernels.spot import NARROWEST
from pico.kernels.start import Start, found

Array = NDArray[np.float64]
_FINE = 24
"""Blocks that a beam is wide at least, where it is that many pixels: the mean over a block is then as good as its
middle, but for a block's own second moment, which is taken off."""
_REACH = 6.0
"""Standard deviations of the start that the fit looks to each side."""
_ROUNDS = 60
_DONE = 1e-7


@dataclass(frozen=True, eq=False)
class Fit:
    """`values`: peak [count], column, row [px], variances along columns, rows, and across [px^2]; their `covariance`
    (6, 6)."""

    values: Array
    covariance: Array

    @property
    def narrow(self) -> bool:
        """Whether it has too few pixels to tell its width."""
        return float(min(self.values[3:5])) < (NARROWEST / 4) ** 2


@dataclass(frozen=True, eq=False)
class _Patch:
    """Means of blocks about a beam: values (n,) without the background's slopes, column and row of each (n,) [blocks],
    and what a slope across and one down make there (n, 2)."""

    values: Array
    columns: Array
    rows: Array
    slopes: Array


def fitted(frame: Frame) -> Fit | str:
    """Return the fit to the brightest spot; why there is none."""
    start = found(frame)
    if isinstance(start, str):
        return start
    by = max(1, min(int(start.width) // _FINE, 16))
    patch, first = _patch(frame, start, by)
    found_at = _least_squares(patch, first)
    if found_at is None:
        return "no Gaussian fits the spot"
    theta, jacobian = found_at
    left = patch.values - _model(theta, patch)[0]
    variance = max(start.background.variance, frame.dark_variance)
    shot = np.maximum(_model(theta, patch)[0] - theta[6], 0) / frame.electrons_per_count
    if start.stripes is not None:
        columns, rows = start.stripes.light(by)
        shot += (columns[patch.columns.astype(int)] + rows[patch.rows.astype(int)]) / frame.electrons_per_count
    scatter = (shot + variance) / by**2
    misfit = max(1.0, float((left**2).sum() / scatter.sum()))
    inverse = np.linalg.inv(jacobian.T @ jacobian)
    covariance = inverse @ (jacobian.T * (scatter * misfit)) @ jacobian @ inverse
    tilted = inverse @ jacobian.T @ patch.slopes
    covariance += tilted @ start.background.covariance[1:, 1:] @ tilted.T
    if start.stripes is not None:
        for variance, places in zip(start.stripes.variances, (patch.columns, patch.rows), strict=True):
            each = np.zeros((int(places.max()) + 1, jacobian.shape[1]))
            np.add.at(each, places.astype(int), jacobian)
            covariance += variance / by * inverse @ each.T @ each @ inverse
    covariance += _rounded(frame, start, theta, jacobian, patch, by, inverse @ jacobian.T)
    return _in_pixels(theta, covariance, by)


def _rounded(frame: Frame, start: Start, theta: Array, jacobian: Array, patch: _Patch, by: int, follow: Array) -> Array:
    """What rounding to whole counts adds to the covariance of the parameters, which follow each block so."""
    out = np.zeros((len(theta), len(theta)))
    reach = 6 * np.sqrt(start.moments[2:4])
    lost = rounding(frame, start.background, start.stripes, start.moments[:2], reach)
    if lost is None:
        return out
    light = _model(theta, patch)[0] - theta[6]
    spread = np.square(jacobian[:, 1:3]).sum(axis=1) / 12 if by > 1 else 0.0  # over a block
    for level in lost.levels:
        shift = follow @ lost.shifts(light, float(level), spread)
        out += np.outer(shift, shift) / len(lost.levels)
    for side in (patch.columns - theta[1], patch.rows - theta[2]) if lost.uneven else ():
        shift = follow @ (lost.pedestal * np.sign(side) * (light > LIT))
        out += np.outer(shift, shift)
    return out


def _in_pixels(theta: Array, covariance: Array, by: int) -> Fit | str:
    scale = np.array([1, by, by, by**2, by**2, by**2], float)
    own = np.array([0, (by - 1) / 2, (by - 1) / 2, -(by**2 - 1) / 12, -(by**2 - 1) / 12, 0])
    values = theta[:6] * scale + own
    values[0] *= math.sqrt(_determinant(theta[3:6] * by**2) / max(_determinant(values[3:]), 1e-9))
    if values[0] <= 0 or _determinant(values[3:]) <= 0:
        return "no Gaussian fits the spot"
    covariance = covariance[:6, :6] * np.outer(scale, scale)
    covariance[3, 3] += PIXEL**2 / 3
    covariance[4, 4] += PIXEL**2 / 3
    return Fit(values, covariance)


def _determinant(variances: Array) -> float:
    return float(variances[0] * variances[1] - variances[2] ** 2)


def _patch(frame: Frame, start: Start, by: int) -> tuple[_Patch, Array]:
    """What is fitted to, and the start: peak, middle and variances [blocks], level."""
    column, row = (start.moments[:2] - (by - 1) / 2) / by
    across, down, both = start.moments[2:] / by**2
    reach_x, reach_y = (max(4.0, _REACH * math.sqrt(v)) for v in (across, down))
    top, left = max(0, int(row - reach_y)), max(0, int(column - reach_x))
    bottom, right = (
        min(int(at + reach) + 2, n // by)
        for at, reach, n in zip((row, column), (reach_y, reach_x), start.shape, strict=True)
    )
    part = binned(start.part(slice(top * by, bottom * by), slice(left * by, right * by)), by).astype(np.float64)
    rows, columns = np.indices(part.shape)
    columns, rows = (columns + left).astype(float), (rows + top).astype(float)
    slopes = _slopes(columns.ravel(), rows.ravel(), by, frame)
    patch = _Patch(part.ravel() - slopes @ start.background.coefficients[1:], columns.ravel(), rows.ravel(), slopes)
    level = start.background.level
    peak = max(float(part.max()) - level, 1e-6)
    return patch, np.array([peak, column, row, across, down, both, level])


def _slopes(columns: Array, rows: Array, by: int, frame: Frame) -> Array:
    """Where blocks are, as shares of the frame's width and height from its middle (n, 2)."""
    h, w = frame.pixels.shape
    return np.stack([(columns + 0.5) * by / w - 0.5, (rows + 0.5) * by / h - 0.5], axis=1)


def _model(theta: Array, patch: _Patch) -> tuple[Array, Array]:
    """The Gaussian on each block, and its derivatives (n, 7)."""
    peak, column, row, across, down, both, level = theta
    x, y = patch.columns - column, patch.rows - row
    inverse = np.linalg.inv(np.array([[across, both], [both, down]]))
    u, v = inverse[0, 0] * x + inverse[0, 1] * y, inverse[0, 1] * x + inverse[1, 1] * y
    shape = np.exp(-(x * u + y * v) / 2)
    light = peak * shape
    rows = [shape, light * u, light * v, light * u * u / 2, light * v * v / 2, light * u * v, np.ones_like(shape)]
    return light + level, np.stack(rows, axis=1)


def _least_squares(patch: _Patch, first: Array) -> tuple[Array, Array] | None:
    """Levenberg-Marquardt: the parameters and the derivatives there; None where it does not settle."""
    theta, damping = first, 1e-3
    model, jacobian = _model(theta, patch)
    cost = float(((patch.values - model) ** 2).sum())
    for _ in range(_ROUNDS):
        normal, slope = jacobian.T @ jacobian, jacobian.T @ (patch.values - model)
        trial = theta + np.linalg.solve(normal + damping * np.diag(np.diag(normal) + 1e-30), slope)
        if min(trial[3], trial[4]) <= 0 or _determinant(trial[3:6]) <= 0:
            damping *= 10
            continue
        model_there, jacobian_there = _model(trial, patch)
        cost_there = float(((patch.values - model_there) ** 2).sum())
        if not cost_there <= cost:
            damping *= 10
            if damping > 1e12:
                return None
            continue
        done = cost - cost_there <= _DONE * cost
        theta, model, jacobian, cost, damping = trial, model_there, jacobian_there, cost_there, damping / 10
        if done:
            return theta, jacobian
    return None
