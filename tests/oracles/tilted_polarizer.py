"""A tilted polarizer that acts on plane waves, each with a 3-D field and an absorbing direction of its own.

Nothing is expanded in the angle of a wave, and nothing comes from `pico.optics`. The beam runs along x, y is to its
left, z up; the plate is turned about z by `tilt`, and its film absorbs level, in the plane of the tilt. Fields are
exp(i(kx - wt)). Jones vectors (y, z) of a wave are those of the frame that the least turn carries there from the beam's
own, as a lens carries what is collimated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Jones = NDArray[np.complex128]
WAVELENGTH = 632.8e-6  # mm


def dot(one: NDArray[np.generic], two: NDArray[np.generic]) -> NDArray[np.generic]:
    """Return the products of vectors (..., 3) without conjugation (..., 1)."""
    return (one * two).sum(axis=-1, keepdims=True)


def behind(jones: Jones, y: Array, z: Array, tilt: float, substrate: Literal["film", "ar_glass"], n: float) -> Jones:
    """Return the Jones vectors (..., 2) behind the plate of waves with direction cosines y and z (...).

    `film`: in matched index. `ar_glass`: each wave is refracted into glass of index n by faces that lose nothing, with
    its s as it was and its p turned along, and out again.
    """
    along = np.stack([np.sqrt(1 - y**2 - z**2), y, z], axis=-1)
    frame = [np.array(e) - (along + np.array([1.0, 0, 0])) * dot(np.array(e), along) / (1 + along[..., :1])
             for e in ([0, 1.0, 0], [0, 0, 1.0])]  # fmt: skip
    field = jones[..., :1] * frame[0] + jones[..., 1:] * frame[1]
    normal = np.array([math.cos(tilt), math.sin(tilt), 0.0])
    absorbs = np.array([-math.sin(tilt), math.cos(tilt), 0.0])
    if substrate == "film":
        field = _absorbed(field, along, absorbs)
    else:
        s = np.cross(normal, along)
        s = s / np.sqrt(dot(s, s))
        level = (along - dot(along, normal) * normal) / n
        inside = level + np.sqrt(1 - dot(level, level)) * normal
        p, q = np.cross(s, along), np.cross(s, inside)
        within = _absorbed(dot(field, s) * s + dot(field, p) * q, inside, absorbs)
        field = dot(within, s) * s + dot(within, q) * p
    return np.concatenate([dot(field, frame[0]), dot(field, frame[1])], axis=-1)


def _absorbed(field: Jones, along: Array, absorbs: Array) -> Jones:
    """Return fields without what lies along the absorbing direction as each wave sees it: across itself."""
    seen = absorbs - dot(absorbs, along) * along
    seen = seen / np.sqrt(dot(seen, seen))
    return field - dot(field, seen) * seen


@dataclass(frozen=True)
class Bench:
    """A collimated beam of 1/e^2 radius `waist` at a lens, the plate in its focus, which is the front focus of a second
    lens, and a camera `away` behind that. Lengths in mm, `tilt` in rad."""

    waist: float
    first: float
    second: float
    tilt: float
    substrate: Literal["film", "ar_glass"] = "film"
    index: float = 1.5


def mean_direction(bench: Bench, jones: Jones, orders: int = 48) -> float:
    """Return the mean direction cosine z behind the plate, by Gauss and Hermite over the plane waves.

    The waves have the intensities exp(-2 Theta^2 / theta_0^2), theta_0 from the cone of the lens and from diffraction.
    """
    theta = math.hypot(bench.waist / bench.first, WAVELENGTH / (math.pi * bench.waist))
    nodes, weights = np.polynomial.hermite.hermgauss(orders)
    y, z = np.meshgrid(nodes * theta / math.sqrt(2), nodes * theta / math.sqrt(2))
    waves = np.broadcast_to(jones, (*y.shape, 2))
    passed = behind(waves, y, z, bench.tilt, bench.substrate, bench.index)
    power = np.outer(weights, weights) * (np.abs(passed) ** 2).sum(axis=-1)
    return float((power * z).sum() / power.sum())


def on_camera(bench: Bench, jones: Jones, away: float, number: int = 1024, width: float = 8.0) -> tuple[float, float]:
    """Return the centroid y and z [mm] on the camera: the whole beam on a grid, lens, space, plate, space, lens, space,
    space and plate plane wave by plane wave. A plate of glass is one that does not walk the beam."""
    k, step = 2 * math.pi / WAVELENGTH, width / number
    line = (np.arange(number) - number // 2) * step
    y, z = np.meshgrid(line, line)
    one, two = np.meshgrid(*[np.fft.fftfreq(number, step) * WAVELENGTH] * 2)
    square = one**2 + two**2

    def space(distance: float) -> Jones:
        return np.exp(-1j * k * distance * square / (1 + np.sqrt(1 - square)))[..., None]

    def lens(focal: float) -> Jones:
        return np.exp(-1j * k * (y**2 + z**2) / (2 * focal))[..., None]

    begun = np.exp(-(y**2 + z**2) / bench.waist**2)[..., None] * lens(bench.first)
    waves = np.fft.fft2(begun, axes=(0, 1)) * space(bench.first) * jones
    waves = behind(waves, one, two, bench.tilt, bench.substrate, bench.index) * space(bench.second)
    at_lens = np.fft.ifft2(waves, axes=(0, 1)) * lens(bench.second)
    ends = np.fft.ifft2(np.fft.fft2(at_lens, axes=(0, 1)) * space(away), axes=(0, 1))
    power = (np.abs(ends) ** 2).sum(axis=-1)
    return float((power * y).sum() / power.sum()), float((power * z).sum() / power.sum())
