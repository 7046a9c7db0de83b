"""Gaussian beams as complex curvatures: how free space, surfaces and thin lenses change them.

The field across a beam is exp(i k n (r' M r / 2)), r (2,) [mm] in the beam's transverse frame, with k in vacuum, n the
index and fields exp(i(kz - wt)). M (2, 2) is symmetric and complex [1/mm]: its real part holds the curvatures of the
wavefront, its imaginary part 2 / (k n w^2). For a round beam M = 1/q, 1/q = 1/R + i wavelength / (pi n w^2). Skew
axes, as of rotated cylinders, need no other case (Arnaud and Kogelnik, Appl. Opt. 8, 1687 (1969)).
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.complex128]
ONE = np.eye(2)


def from_waist(radius: float, wavelength: float, behind: float = 0.0) -> Matrix:
    """Return M of a round beam `behind` its waist [mm] of a 1/e^2 radius [mm]; `wavelength` in the medium, times M^2
    of the beam [mm]."""
    round_one: Matrix = ONE.astype(complex) / complex(behind, -math.pi * radius**2 / wavelength)
    return round_one


def inverse(matrix: NDArray[Any]) -> NDArray[Any]:
    """Return the inverse of a matrix (2, 2) in closed form: a tenth of the time of LAPACK's; raises ZeroDivisionError
    for a singular one."""
    (a, b), (c, d) = matrix.tolist()
    size = a * d - b * c
    return np.array([[d / size, -b / size], [-c / size, a / size]])


def stretch(curvature: Matrix, distance: float) -> NDArray[np.complex128]:
    """Return 1 + d M, by which a distance d [mm] widens a beam."""
    return ONE + distance * curvature


def phase(curvature: Matrix, distance: float) -> float:
    """Return the phase of det(1 + d M) [rad], followed from d = 0: each axis turns by less than pi."""
    (a, b), (c, d) = curvature.tolist()
    middle, apart = (a + d) / 2, cmath.sqrt(((a - d) / 2) ** 2 + b * c)  # the eigenvalues are middle -+ apart
    return sum(cmath.phase(1 + distance * axis) for axis in (middle + apart, middle - apart))


def forward(curvature: Matrix, distance: float) -> Matrix:
    """Return M after a distance [mm]: M (1 + d M)^-1; raises ZeroDivisionError where a beam without width comes to a
    point."""
    return _symmetric(curvature @ inverse(stretch(curvature, distance)))


def through(
    curvature: Matrix,
    before: NDArray[np.float64],
    after: NDArray[np.float64],
    indices: tuple[float, float],
    facing: tuple[float, float],
    shape: NDArray[np.float64],
) -> Matrix:
    """Return M behind a surface that refracts or reflects, at any incidence.

    `before`, `after` (2, 2): the transverse axes of the beam (rows) along two axes in the tangent plane (columns);
    `indices`: refractive, before and after, the same for a mirror; `facing`: the beam's direction along the normal,
    before and after; `shape` (2, 2): the surface's curvatures along the two axes [1/mm], positive where it bends to
    where the normal points. The phase must be the same on both sides of the surface, to second order:
    n (B'MB + cos S) = n' (A'M'A + cos' S).
    """
    ratio = indices[0] / indices[1]
    mapped = ratio * before.T @ curvature @ before + (ratio * facing[0] - facing[1]) * shape
    back = inverse(after)
    return _symmetric(back.T @ mapped @ back)


def _symmetric(found: Any) -> Matrix:
    whole: Matrix = (found + found.T) / 2
    return whole


def widths(curvature: Matrix, wavelength: float) -> tuple[float, float, float]:
    """Return the 1/e^2 radii [mm] along the principal axes, the larger first, and the direction of that axis from the
    first transverse one, counter-clockwise looking into the beam [rad, 0 to pi]. `wavelength` as in `from_waist`."""
    (a, b), (_, d) = (np.imag(curvature) * (math.pi / wavelength)).tolist()
    middle, apart = (a + d) / 2, math.hypot((a - d) / 2, b)
    small, large = middle - apart, middle + apart
    angle = (math.atan2(2 * b, a - d) / 2 + math.pi / 2) % math.pi if 2 * apart > 1e-9 * large else 0.0
    return 1 / math.sqrt(small), 1 / math.sqrt(large), angle


def front(curvature: Matrix) -> tuple[float, float]:
    """Return the curvatures of the wavefront [1/mm] along its principal axes; positive where the beam diverges."""
    low, high = np.linalg.eigvalsh(np.real(curvature))
    return float(high), float(low)
