"""Pictures of beams whose truth is known, as a camera takes them: shot noise, read noise, black level, whole counts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.kernels.frame import Frame, Readings

BLACK = 64
ELECTRONS = 3.66
READ_NOISE = 2.5


@dataclass(frozen=True)
class Beam:
    """A Gaussian beam: D4sigma widths [px], angle counter-clockwise as one sees the picture [deg], peak [count], middle
    off that of the sensor [px, right and up], and a background that rises so much from left to right [count]."""

    major: float
    minor: float
    angle: float = 0.0
    peak: float = 3000.0
    x: float = 0.0
    y: float = 0.0
    tilt: float = 0.0


def places(shape: tuple[int, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return x (1, w) to the right and y (h, 1) up of each pixel [px], from the middle."""
    h, w = shape
    return (np.arange(w) - (w - 1) / 2)[None], ((h - 1) / 2 - np.arange(h))[:, None]


def light(beam: Beam, shape: tuple[int, int]) -> NDArray[np.float64]:
    """Return the light of a beam on each pixel [count]."""
    x, y = places(shape)
    x, y = x - beam.x, y - beam.y
    c, s = np.cos(np.radians(beam.angle)), np.sin(np.radians(beam.angle))
    along, across = c * x + s * y, c * y - s * x
    return beam.peak * np.exp(-((along / beam.major) ** 2 + (across / beam.minor) ** 2) * 8)


def taken(counts: NDArray[np.float64], seed: int, pixel_size: float = 1.0) -> Frame:
    """Return the frame that a 12-bit camera takes of light [count]."""
    noise = np.random.default_rng(seed)
    electrons = noise.poisson(counts * ELECTRONS) + noise.normal(0, READ_NOISE, counts.shape)
    pixels = np.clip(np.rint(electrons / ELECTRONS + BLACK), 0, 4095).astype(np.uint16)
    return Frame(pixels, pixel_size=pixel_size, black_level=BLACK, electrons_per_count=ELECTRONS, read_noise=READ_NOISE)


def picture(beam: Beam, shape: tuple[int, int], seed: int) -> Frame:
    """Return a picture of a beam, seeded; pixels of 1 um."""
    x, _ = places(shape)
    return taken(light(beam, shape) + beam.tilt * (x / shape[1] + 0.5), seed)


def fringe_picture(visibility: float, shape: tuple[int, int], seed: int) -> Frame:
    """Return straight fringes of 17.3 px at 20 deg on a broad beam, dim enough for noise to matter."""
    x, y = places(shape)
    phase = 2 * np.pi * (x * np.cos(np.radians(20)) + y * np.sin(np.radians(20))) / 17.3
    broad = light(Beam(shape[1], shape[1], peak=600), shape)
    return taken(broad * (1 + visibility * np.cos(phase + 0.7)), seed)


NOISE = 0.005
"""The share of each reading that is noise, one standard deviation."""
_ANALYZERS = {
    "across": (1, 0), "up": (0, 1), "diagonal": (1, 1), "antidiagonal": (1, -1),
    "positive": (1, 1j), "negative": (1, -1j),
}  # fmt: skip


def field(stokes: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return a Jones vector, across and up, of fully polarized light of S1 to S3 with S0 = 1, by
    `pico.optics.polarization`: S3 = 2 Im(conj(Ex) Ey)."""
    across = np.sqrt((1 + stokes[0]) / 2)
    return np.array([across, (stokes[1] + 1j * stokes[2]) / (2 * across)])


def _read(powers: NDArray[np.float64], seed: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    noise = np.random.default_rng(seed).normal(0, NOISE, len(powers))
    return tuple((powers * (1 + noise)).tolist()), tuple((powers * NOISE + 1e-9).tolist())


def six_states(stokes: NDArray[np.float64], seed: int) -> Readings:
    """Return the powers behind six analyzers, by projection."""
    axes = [np.array(a) / np.linalg.norm(a) for a in _ANALYZERS.values()]
    values, sigma = _read(np.array([abs(np.vdot(a, field(stokes))) ** 2 for a in axes]), seed)
    return Readings(values, sigma, names=tuple(_ANALYZERS))


def turned_plate(stokes: NDArray[np.float64], seed: int, retardance: float, count: int = 8) -> Readings:
    """Return the powers behind a plate at so many angles and an analyzer across, by Jones matrices: exp(-iwt), so the
    slow axis is ahead by `retardance` [deg] in phase."""
    angles = tuple((np.arange(count) * 180 / count).tolist())
    powers = []
    for angle in np.radians(angles):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        plate = turn.T @ np.diag([1, np.exp(1j * np.radians(retardance))]) @ turn
        powers.append(abs((plate @ field(stokes))[0]) ** 2)
    values, sigma = _read(np.array(powers), seed)
    return Readings(values, sigma, angles=angles)
