"""Principal axes of second moments. Needs numpy at its top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_ANY_ANGLE = 180 / np.sqrt(12)
"""One standard deviation of an angle of which nothing is known [deg]."""
_PARTED = 0.75
"""Between the half that holds for long ellipses and the 1.25 of round ones."""


@dataclass(frozen=True, eq=False)
class Ellipse:
    """`values`: one standard deviation along the major axis, along the minor one [px], the angle of the major one
    [deg], counter-clockwise from the columns' direction as one sees the picture; `sigma` of each; and the relative
    uncertainty of minor to major, `ratio_sigma`, which vary together."""

    values: NDArray[np.float64]
    sigma: NDArray[np.float64]
    ratio_sigma: float


def _split(direction: NDArray[np.float64], r: float, covariance: NDArray[np.float64]) -> float:
    """How far noise alone parts the axes of a round beam, of which the greater is called major: half the difference of
    variances that it makes [px^2]. Of two numbers without bias, their root of squares r is too large by s^2/2r."""
    half = np.array([[0.5, 0.5, 0], [0.5, -0.5, 0], [0, 0, 1]])
    variance = float(direction @ half @ covariance @ half.T @ direction)
    return _PARTED * variance / max(r, math.sqrt(max(variance, 1e-300)))


def ellipse(variances: NDArray[np.float64], covariance: NDArray[np.float64]) -> Ellipse:
    """Return the axes of variances along columns, rows and across [px^2, rows run down], with their covariance (3, 3).

    Eigenvalues a +- r of the 2 x 2 matrix, a their mean, r = hypot(d, b), with d half the difference of the variances
    and b the third; tan(2 angle) = b/d.
    """
    across, down, b = variances
    a, d = (across + down) / 2, (across - down) / 2
    r = max(float(np.hypot(d, b)), 1e-12 * a)
    deviations = np.sqrt(np.maximum([a + r, a - r], 1e-12 * a))
    cos, sin = d / r, b / r
    values = np.array([[(1 + cos) / 2, (1 - cos) / 2, sin], [(1 - cos) / 2, (1 + cos) / 2, -sin]])
    turn = np.degrees(np.array([[-sin / 2, sin / 2, cos]]) / (2 * r))
    follow = np.vstack([values / (2 * deviations[:, None]), -turn])
    own = follow @ covariance @ follow.T
    sigma = np.sqrt(np.maximum(np.diag(own), 0))
    sigma[2] = min(sigma[2], _ANY_ANGLE)
    sigma[:2] = np.hypot(sigma[:2], _split(np.array([0.0, cos, sin]), r, covariance) / (2 * deviations))
    apart = np.array([1 / deviations[0], -1 / deviations[1]])
    relative = float(np.sqrt(max(apart @ own[:2, :2] @ apart, 0)))
    return Ellipse(np.array([*deviations, -np.degrees(np.arctan2(b, d)) / 2]), sigma, relative)
