"""A beam's widths along its way: waist, divergence and beam propagation ratio M2, by ISO 11146-1, 9. Needs numpy at its
top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
FEWEST = 4
"""Places without which three coefficients leave nothing to tell how well they fit."""


@dataclass(frozen=True)
class Caustic:
    """`m2`; the `waist`'s width [um] and place [mm]; full `divergence` [mrad]; `rayleigh` length [mm]; `sigma`: one
    standard deviation of each in that order; `near`, `far`: how many places lie within one Rayleigh length of the
    waist, and beyond two."""

    m2: float
    waist: float
    at: float
    divergence: float
    rayleigh: float
    sigma: tuple[float, float, float, float, float]
    near: int
    far: int


def caustic(places: Array, widths: Array, sigma: Array, wavelength: float) -> Caustic | str:
    """Return the hyperbola d^2 = a + b z + c z^2 through widths d (n,) [um] with their standard deviations at places z
    (n,) [mm], in light of a wavelength [nm]; why there is none.

    M2 = pi / (8 lambda) sqrt(4ac - b^2). The deviations grow by the misfit where that exceeds them.
    """
    if len(set(places.tolist())) < FEWEST:
        return f"a caustic needs {FEWEST} places along the beam or more, not {len(set(places.tolist()))}"
    middle, reach = float(places.mean()), float(np.ptp(places)) / 2
    z, squares = (places - middle) / reach, (widths * 1e-3) ** 2
    weights = 1 / np.maximum(2 * widths * sigma * 1e-6, 1e-9 * squares.max())
    basis = np.vander(z, 3, increasing=True)
    inverse = np.linalg.inv((basis * weights[:, None] ** 2).T @ basis)
    found = inverse @ (basis.T @ (squares * weights**2))
    left = (squares - basis @ found) * weights
    covariance = inverse * max(1.0, float(left @ left) / (len(z) - 3) if len(z) > 3 else 1.0)
    made = _numbers(found, reach, middle, wavelength)
    if made is None:
        return "no waist: the squared widths do not follow a parabola that opens upward and stays above zero"
    steps = np.sqrt(np.diag(covariance)) * 1e-3
    slopes = []
    for i, step in enumerate(steps):
        moved = [_numbers(found + sign * step * np.eye(3)[i], reach, middle, wavelength) for sign in (1, -1)]
        if moved[0] is None or moved[1] is None:
            return "no waist: the widths are too uncertain to tell one"
        slopes.append((moved[0] - moved[1]) / (2 * step))
    follow = np.array(slopes).T
    s0, s1, s2, s3, s4 = np.sqrt(np.diag(follow @ covariance @ follow.T)).tolist()
    m2, waist, at, divergence, rayleigh = made.tolist()
    away = np.abs(places - at)
    near, far = int((away <= rayleigh).sum()), int((away >= 2 * rayleigh).sum())
    return Caustic(m2, waist, at, divergence, rayleigh, (s0, s1, s2, s3, s4), near, far)


def _numbers(found: Array, reach: float, middle: float, wavelength: float) -> Array | None:
    """M2, waist [um] and its place [mm], divergence [mrad], Rayleigh length [mm] of a parabola [mm^2]."""
    a, b, c = found[0], found[1] / reach, found[2] / reach**2
    root = 4 * a * c - b**2
    if c <= 0 or root <= 0:
        return None
    m2 = math.pi / (8 * wavelength * 1e-6) * math.sqrt(root)
    waist = math.sqrt(root / (4 * c))
    return np.array([m2, waist * 1e3, middle - b / (2 * c), math.sqrt(c) * 1e3, math.sqrt(root) / (2 * c)])
