"""Plates that treat each plane wave of a beam a little otherwise: a tilted polarizer shifts light sideways.

A plane wave that comes under another angle finds another axis: the absorbing direction a of a film, in the plate's
plane, is seen projected across the wave. To first order in its angle Theta (2,) the axis turns by psi = g . Theta, and
a turn by psi is a phase exp(-+ i psi) of the two circular parts, that is a shift of each by -+ g / k: the spin Hall
effect (for a tilted film |g| = tan theta; derivation and checks: Bliokh et al., arXiv 1907.08795). So a beam of
Gaussian waves stays one, with more waves that interfere. It holds where Theta^2 terms of psi do not count: see `HOLDS`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from pico.optics.beam import Beam, Wave, merged
from pico.optics.polarization import Vector, fresnel, joined, plane_of_incidence, product, split

Substrate = Literal["film", "ar_glass", "glass"]
HOLDS = (0.03, math.radians(60))
"""Divergence and tilt [rad] up to which the turn of the axis is taken as linear: there within 0.04 % of plane waves."""
_STEP = 1e-4  # rad, over which the turn is differenced
CIRCULAR = (1j, -1j)


def polarized(
    beam: Beam, normal: Vector, axis: Vector, passes: float, extinction: float, substrate: Substrate, index: float
) -> Beam:
    """Return a beam behind a polarizer whose film absorbs along `axis` (3,), a direction in its plane.

    `passes`: the share of the power along its transmission axis, `extinction`: how much less passes across it.
    `substrate`: the film in matched index, in anti-reflection coated glass of `index`, or in bare glass.
    """
    turn = _axis_of(beam, normal, axis, substrate, index)
    angle, gradient = turn(np.zeros(2)), np.zeros(2)
    if 1 - abs(float(beam.along @ normal)) > 1e-12:
        steps = _STEP * np.eye(2)
        gradient = np.array([_less(turn(step), turn(-step)) / (2 * _STEP) for step in steps])
    strong, weak = math.sqrt(passes), math.sqrt(passes / extinction)
    # in circular parts: (strong + weak)/2 keeps a part, (strong - weak)/2 turns one into the other with the axis twice
    kept, swapped = (strong + weak) / 2, (strong - weak) / 2
    unit = {sign: (beam.across + sign * beam.up) / math.sqrt(2) for sign in CIRCULAR}
    waves: list[Wave] = []
    for wave in beam.waves:
        for sign in CIRCULAR:
            part = wave.field @ np.conj(unit[sign])
            waves.append(Wave(kept * part * unit[sign], wave.shift, wave.group))
            turned = Wave(swapped * part * np.exp(2 * sign * angle) * unit[-sign], wave.shift, wave.group)
            waves.append(_shifted(beam, turned, 2 * (sign / 1j).real * gradient))
    return replace(beam, waves=merged(waves))


def linear(beam: Beam, normal: Vector) -> str:
    """Return why `polarized` cannot be believed, in words; empty where it can."""
    radius = beam.widths[1]
    spread = 2 / (beam.wave_number * radius)
    slope = max(abs(radius * c) for c in np.linalg.eigvalsh(np.real(beam.curvature)))
    divergence, tilt = math.hypot(spread, slope), math.acos(min(1.0, abs(float(beam.along @ normal))))
    if divergence <= HOLDS[0] and tilt <= HOLDS[1]:
        return ""
    return f"a polarizer tilted by {math.degrees(tilt):.0f}° in a beam of {1000 * divergence:.0f} mrad"


def _shifted(beam: Beam, wave: Wave, by: NDArray[np.float64]) -> Wave:
    """Return a wave times exp(i by . Theta) in the far field, which is itself, by / k further back."""
    back = by * beam.wavelength / (2 * math.pi * beam.index)
    slope = beam.curvature @ back
    phase = np.exp(1j * beam.wave_number * (back @ slope / 2 + wave.shift @ back))
    return Wave(wave.field * phase, wave.shift + slope, wave.group)


def _axis_of(
    beam: Beam, normal: Vector, axis: Vector, substrate: Substrate, index: float
) -> Callable[[NDArray[np.float64]], float]:
    """Return the angle of the transmission axis [rad] in a plane wave's own frame, carried there from the beam's, as a
    function of that wave's direction (2,) from the chief ray [rad]."""
    outward = normal if beam.along @ normal > 0 else -normal

    def angle(theta: NDArray[np.float64]) -> float:
        along = beam.along + theta @ beam.frame
        along = along / np.linalg.norm(along)
        across, up = (_carried(v, beam.along, along) for v in (beam.across, beam.up))
        passing = _passing(along, outward, axis, substrate, index)
        return math.atan2(float(passing @ up), float(passing @ across))

    return angle


def _carried(vector: Vector, before: Vector, after: Vector) -> Vector:
    """Return a transverse vector carried along by the least turn that takes one direction to another."""
    turned: Vector = vector - (before + after) * float(vector @ after) / (1 + float(before @ after))
    return turned


def _passing(along: Vector, normal: Vector, axis: Vector, substrate: Substrate, index: float) -> Vector:
    """Return the direction of the field of a plane wave of which most passes, before the plate."""
    if substrate == "film":
        passing: Vector = product(along, axis)
        return np.asarray(passing / np.linalg.norm(passing))
    cosine = float(along @ normal)
    inside = along / index + (math.sqrt(1 - (1 - cosine**2) / index**2) - cosine / index) * normal
    s = plane_of_incidence(along, normal, _any_across(along))
    within: Any = product(inside, axis)
    s_part, p_part = split(within / np.linalg.norm(within), inside, s)
    if substrate == "glass":  # the film's axis, seen back through a face that passes p better than s
        _, _, t_s, t_p = fresnel(1.0, index, cosine)
        s_part, p_part = s_part * t_s.real, p_part * t_p.real
    before: Vector = np.real(joined(s_part, p_part, along, s))
    return before / np.linalg.norm(before)


def _any_across(along: Vector) -> Vector:
    across: Vector = product(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    return np.asarray(across / np.linalg.norm(across))


def _less(a: float, b: float) -> float:
    """Return the difference of two directions of an axis [rad]."""
    return (a - b + math.pi / 2) % math.pi - math.pi / 2
