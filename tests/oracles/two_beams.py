"""Two beams of one source on a screen, written apart from `pico.optics`: mirrors are reflections of complex numbers in
the plane of the table, a beam is the scalar Gaussian of a textbook (Siegman, Lasers, 17.1), light of a spectrum is a
sum over its frequencies. Polarization stands upright, so each mirror turns the sign and each cube adds a quarter of a
wave to what it reflects. Lengths in mm."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

LIGHT = 299792458e3  # mm/s
Mirror = tuple[complex, float]
"""A point of a mirror, and the direction of its face seen from above [rad]."""


@dataclass(frozen=True)
class Arm:
    """Where a beam comes by, in which direction, how long its way has been, and with which amplitude."""

    at: complex
    way: complex
    length: float
    amplitude: complex


def folded(at: complex, way: complex, mirrors: Sequence[Mirror], amplitude: complex = 1.0) -> Arm:
    """Return a beam behind mirrors."""
    length = 0.0
    for point, face in mirrors:
        line = cmath.exp(1j * face)
        far = (line.conjugate() * (point - at)).imag / (line.conjugate() * way).imag
        at, way, length = at + far * way, line**2 * way.conjugate(), length + far
    return Arm(at, way, length, amplitude)


def field(
    arm: Arm, place: np.ndarray, height: np.ndarray, waist: float, wavelength: float, looks: complex
) -> tuple[np.ndarray, ...]:
    """Return the slow amplitude of a beam of 1 mW whose waist is at its start, on a screen that `looks` along a
    direction, and how far along its way each point is that lies above `place` (complex) of the table by `height`."""
    ahead = (place - arm.at) * arm.way.conjugate()
    z, rho2 = arm.length + ahead.real, ahead.imag**2 + height**2
    k, rayleigh = 2 * math.pi / wavelength, math.pi * waist**2 / wavelength
    w2 = waist**2 * (1 + (z / rayleigh) ** 2)
    bend = z / (z**2 + rayleigh**2)
    phase = 0.5 * k * rho2 * bend - np.arctan(z / rayleigh)
    aslant = (arm.way * looks.conjugate()).real
    return arm.amplitude * np.sqrt(2 * aslant / (math.pi * w2)) * np.exp(-rho2 / w2 + 1j * phase), z


def screen(
    arms: Sequence[Arm], place: np.ndarray, height: np.ndarray, waist: float, wavelength: float,
    spectrum: Sequence[tuple[float, float]] = ((0.0, 1.0),), *, looks: complex,
) -> np.ndarray:  # fmt: skip
    """Return the irradiance of beams at points of a screen that `looks` along a direction; `spectrum`: offsets of
    frequency [Hz] and their shares."""
    beams = [field(arm, place, height, waist, wavelength, looks) for arm in arms]
    total = np.zeros(np.broadcast(place, height).shape)
    for offset, share in spectrum:
        k = 2 * math.pi * (1 / wavelength + offset / LIGHT)
        total += share * np.abs(sum(amplitude * np.exp(1j * k * z) for amplitude, z in beams)) ** 2
    return total


def gaussian_line(width: float) -> Callable[[float], float]:
    """Return the spectrum of a Gaussian line by its full width at half maximum, normalized."""
    sigma = width / math.sqrt(8 * math.log(2))
    return lambda nu: math.exp(-0.5 * (nu / sigma) ** 2) / (sigma * math.sqrt(2 * math.pi))


def lorentzian_line(width: float) -> Callable[[float], float]:
    half = width / 2
    return lambda nu: half / math.pi / (nu**2 + half**2)


def visibility(line: Callable[[float], float], width: float, delta: float) -> float:
    """Return the visibility of a symmetric line at a difference of paths: twice the cosine transform of its one side,
    by quadrature over frequencies in units of its width."""
    turn = 2 * math.pi * width * abs(delta) / LIGHT
    if turn < 1e-5:  # below what the quadrature can tell
        return 1.0
    found = quad(lambda x: width * line(width * x), 0, np.inf, weight="cos", wvar=turn, limlst=200, limit=200)
    return 2 * float(found[0])


def overlap(waist: float, wavelength: float, delta: float) -> complex:
    """Return the overlap of two Gaussian beams of one waist on one axis, of which one has gone further: the integral of
    exp(-rho2 (1/w0^2) ...) over all plane waves, whose phases differ by k_rho^2 delta / 2 k."""
    k = 2 * math.pi / wavelength
    real = quad(lambda u: math.exp(-u) * math.cos(u * delta / (k * waist**2)), 0, 80, epsabs=1e-12)[0]
    imag = quad(lambda u: math.exp(-u) * math.sin(u * delta / (k * waist**2)), 0, 80, epsabs=1e-12)[0]
    return complex(real, -imag)


def demodulated(picture: np.ndarray, across: np.ndarray, period: float) -> float:
    """Return the visibility of upright fringes on a smooth light: twice its transform at a period, or near it where
    that is greatest, to that at none, all under a Hann window."""
    hann = [np.sin(np.pi * np.arange(1, n + 1) / (n + 1)) ** 2 for n in picture.shape]
    seen = hann[0] @ picture * hann[1]
    best = minimize_scalar(
        lambda f: -abs((seen * np.exp(2j * np.pi * f * across)).sum()), (0.999 / period, 1.001 / period), tol=1e-10
    )
    return float(-2 * best.fun / seen.sum())
