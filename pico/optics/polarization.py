"""Polarization as a field vector in space: interfaces, plates, Stokes parameters, and the words for angles.

Conventions, tested: fields are exp(i(kz - wt)). A beam's transverse frame is (across, up), with across x up = along;
where a beam runs level, `across` is level and to its left, `up` is up. Angles run counter-clockwise looking into the
beam (towards the source) from `across`. (1, i)/sqrt 2 has S3 = +1: its field turns counter-clockwise looking into the
beam. What is turned round by a yaw of 180 deg shows minus its angle.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Field = NDArray[np.complex128]


def stokes(across: Any, up: Any) -> tuple[float, float, float, float]:
    """Return S0 to S3 of field components along `across` and `up`: S3 = 2 Im(conj(Ex) Ey)."""
    x, y = np.asarray(across), np.asarray(up)
    s0 = float(np.sum(np.abs(x) ** 2 + np.abs(y) ** 2))
    s1 = float(np.sum(np.abs(x) ** 2 - np.abs(y) ** 2))
    cross = complex(np.sum(np.conj(x) * y))
    return s0, s1, 2 * cross.real, 2 * cross.imag


def product(a: Any, b: Any) -> Vector:
    """Return the vector product of two vectors (3,): a twentieth of the time of numpy's, which takes any axes."""
    (one, two, three), (x, y, z) = a.tolist(), b.tolist()
    return np.array([two * z - three * y, three * x - one * z, one * y - two * x])


def plane_of_incidence(along: Vector, normal: Vector, level: Vector) -> Vector:
    """Return the unit vector s across the plane of incidence; `level` where the ray comes along the normal."""
    s = product(normal, along)
    size = float(np.linalg.norm(s))
    return level if size < 1e-12 else s / size


def carried(vector: Vector, before: Vector, after: Vector, s: Vector) -> Vector:
    """Return a transverse vector (3,) behind a turn about s: along s and p as it was."""
    return np.real(joined(*split(vector, before, s), after, s))


def split(field: Any, along: Vector, s: Vector) -> tuple[Any, Any]:
    """Return the components of fields (..., 3) along s and p = s x along."""
    return field @ s, field @ product(s, along)


def joined(s_part: Any, p_part: Any, along: Vector, s: Vector) -> Field:
    """Return fields (..., 3) of components along s and p = s x along."""
    whole: Field = np.multiply.outer(s_part, s) + np.multiply.outer(p_part, product(s, along))
    return whole


def fresnel(before: complex, after: complex, cosine: float) -> tuple[complex, complex, complex, complex]:
    """Return the amplitudes r_s, r_p, t_s, t_p of an interface; `cosine` of the angle of incidence, above 0.

    p = s x along on either side, so at normal incidence r_p = -r_s. Indices n + ik belong to exp(-iwt). Born and Wolf,
    Principles of Optics, 1.5.2.
    """
    inside = np.sqrt(complex(1 - (before / after) ** 2 * (1 - cosine**2)))
    one, two = before * cosine, after * inside
    three, four = after * cosine, before * inside
    return (one - two) / (one + two), (three - four) / (three + four), 2 * one / (one + two), 2 * one / (three + four)
