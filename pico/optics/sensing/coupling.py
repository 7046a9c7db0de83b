"""What a single-mode fiber takes of a beam: what is in its mode."""

from __future__ import annotations

import math

import numpy as np

from pico.optics import gaussian
from pico.optics.beam import Beam, forward
from pico.optics.part import Part


def coupled(part: Part, beam: Beam) -> float:
    """Return the share of a beam's power that a fiber takes: |<mode|beam>|^2, in closed form.

    In front of its collimator the mode is a Gaussian of the radius `mode_radius`, its waist at the origin of the
    optical frame, along local x; any polarization is taken. Over the plane across the mode both are of the form
    E exp(i k (r' M r / 2 + b . r)), so that the overlap is that of Gaussians with N = M - conj(M of the mode):
    2 pi / (k sqrt(det(-i N))) exp(-i k b' N^-1 b / 2). Paraxial, as light that couples is.
    """
    axis = part.axes[0]
    facing = float(beam.along @ axis)
    if facing < _PARAXIAL:
        return 0.0
    came = forward(beam, float((part.origin - beam.at) @ axis) / facing)
    k = came.wave_number
    mode = gaussian.from_waist(part.number("mode_radius", "mm", 1.0), came.wavelength / came.index)
    place = came.frame @ (part.origin - came.at)
    tilt = came.frame @ axis / facing
    difference = came.curvature - np.conj(mode)
    inverse = np.linalg.inv(difference)
    norm = k**2 * math.sqrt(np.linalg.det(came.curvature.imag) * np.linalg.det(mode.imag)) / math.pi**2
    size = 2 * math.pi / (k * np.sqrt(np.linalg.det(-1j * difference)))
    taken: dict[int, np.ndarray[tuple[int], np.dtype[np.complex128]]] = {}
    for wave in came.waves:
        # around the middle of the mode: r = place + s
        slope = wave.shift + came.curvature @ place - tilt
        phase = place @ came.curvature @ place / 2 + wave.shift @ place - slope @ inverse @ slope / 2
        amplitude = size * np.exp(1j * k * phase)
        taken[wave.group] = taken.get(wave.group, np.zeros(3, complex)) + amplitude * wave.field
    power = norm * sum(float((np.abs(field) ** 2).sum()) for field in taken.values())
    return min(1.0, power / came.power) if came.power else 0.0


_PARAXIAL = math.cos(math.radians(20))
