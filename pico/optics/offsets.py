"""How far light comes beside a place that it is to come to, and how much of it is lost by that."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pico.optics import gaussian
from pico.optics.beam import Beam, forward, level
from pico.optics.part import Part, within

if TYPE_CHECKING:
    from pico.optics.light import Light

Array = NDArray[np.float64]
_STEP = 0.02
"""Of a width, by which a fiber is moved beside a beam to find how much it takes."""
_PARAXIAL = math.cos(math.radians(20))
"""The cosine of the angle beyond which light does not couple into a fiber."""


@dataclass(frozen=True)
class Place:
    """A component that light is to come to. `opening`: how wide it will be open meanwhile [mm], None where that is for
    its type to say. `by`: components by which it comes there; light that did not meet one of them does not count."""

    component: str
    opening: float | None = None
    by: frozenset[str] = frozenset()


@dataclass(frozen=True, eq=False)
class Falling:
    """How the logarithm of the power falls with offsets o: o' shape o; and the power at its best [mW]."""

    shape: Array
    power: float


def offset(light: Light, place: Place) -> Array | None:
    """Return by how much the strongest beam passes beside the middle of a place: to the left and up [mm]; for a fiber
    its slopes, too [rad]; for a spatial filter in its focus, beside the pinhole. None where none comes there."""
    beam = _strongest(light, place)
    if beam is None:
        return None
    part = light.parts[place.component]
    ahead, left, up = part.axes
    facing = float(beam.along @ ahead)
    middle = part.center if part.optic.element == "iris" else part.origin
    at = beam.at + beam.along * float((middle - beam.at) @ ahead) / facing - middle
    across = np.array([at @ left, at @ up])
    slopes = np.array([beam.along @ left, beam.along @ up]) / facing
    if part.optic.element == "spatial_filter":
        hole = [part.value(f"pinhole_{axis}", "mm", 0.0) for axis in "yz"]
        return np.asarray(part.number("focal_length", "mm", 10.0) * slopes - hole)
    return np.concatenate([across, slopes]) if _is_fiber(part) else across


def falling(light: Light, place: Place) -> Falling | None:
    """Return how the power behind a place, or on it, falls with the offsets of the strongest beam."""
    beam = _strongest(light, place)
    if beam is None:
        return None
    part = light.parts[place.component]
    if _is_fiber(part):
        return _into_fiber(part, beam)
    ahead = part.axes[0]
    came = forward(beam, float((part.origin - beam.at) @ ahead) / float(beam.along @ ahead))
    wide, radius = came.widths[0], _radius(part, place)
    if part.optic.element == "spatial_filter":
        wide = came.wavelength * part.number("focal_length", "mm", 10.0) / (math.pi * wide)
    # the variances of the spot and of the opening, which is evenly open, add up
    width = math.sqrt((wide**2 + radius**2) / 2)
    share = 1.0 if part.optic.element == "spatial_filter" else within(came, np.zeros(2), radius)
    return Falling(np.eye(2) / width**2, came.power * share)


def _strongest(light: Light, place: Place) -> Beam | None:
    """Return the strongest beam that comes to a place by a tuned part, else the strongest at all: one that is tuned
    itself may be the first that it meets."""
    found = [(n, c) for n, c in enumerate(light.crossings) if c.component == place.component and c.event != "blocked"]
    by = [c for n, c in found if any(one.component in place.by for one in light.way(n)[:-1])]
    return max((c.beam for c in by or [c for _, c in found]), key=lambda beam: beam.power, default=None)


def _is_fiber(part: Part) -> bool:
    return "mode_radius" in part.kind.parameters


def _radius(part: Part, place: Place) -> float:
    """Return how far from its middle a place takes light [mm]."""
    if place.opening is not None:
        return place.opening / 2
    if part.optic.element == "iris":
        return part.number("diameter", "mm", 2 * part.optic.radius) / 2
    if part.optic.element == "spatial_filter":
        return part.number("pinhole", "mm", 0.02) / 2
    across, up = (part.number(f"pixels_{way}", "pixel", 0.0) for way in ("across", "up"))
    if across and up:
        return min(across, up) * part.number("pixel_size", "um", 1.0) * 1e-3 / 2
    return part.number("active_diameter", "mm", 2 * part.optic.radius) / 2


def _into_fiber(part: Part, beam: Beam) -> Falling:
    """Return how a fiber loses a beam, by what it takes of it beside its middle and aslant: second differences."""
    ahead, left, up = part.axes
    came = forward(beam, float((part.origin - beam.at) @ ahead) / float(beam.along @ ahead))
    mode = part.number("mode_radius", "mm", 1.0)
    steps = np.array([mode, mode, *[came.wavelength / (math.pi * mode)] * 2]) * _STEP

    def taken(moved: Array) -> float:
        y, z, dy, dz = (moved * steps).tolist()
        along = ahead + dy * left + dz * up
        along = along / np.linalg.norm(along)
        aside = replace(came, at=part.origin + y * left + z * up, along=along, across=level(along, came.across))
        return math.log(max(coupled(part, aside), 1e-300))

    best, unit = taken(np.zeros(4)), np.eye(4)
    shape = np.zeros((4, 4))
    for i in range(4):
        for j in range(i, 4):
            both = sum(s * t * taken(s * unit[i] + t * unit[j]) for s in (1, -1) for t in (1, -1)) / 4
            shape[i, j] = shape[j, i] = -both / 2 / (steps[i] * steps[j])
    return Falling(shape, math.exp(best) * came.power * part.number("transmission", "", 1.0))


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
