"""A component as light finds it, and what an element makes of a beam: what `pico.optics.elements` share."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from pico.model.catalog import ComponentType
from pico.model.pose import Pose
from pico.model.quantities import QuantityError, convert
from pico.optics.axis import Optic
from pico.optics.beam import Beam, Wave, forward, groups_of, scaled
from pico.optics.geometry import Event, geometry_of
from pico.optics.polarization import Vector
from pico.optics.rays import Surface
from pico.optics.unseen import SEEN, Unseen

SPOT = 0.9
"""The share that must pass an edge for the spot behind it to be taken as Gaussian still: a circle of radius 1.07 w."""


@dataclass(frozen=True, eq=False)
class Part:
    """A component that stands on the table: its type, tunables in the units of the catalog, pose, its optic, and what
    nobody sees of it."""

    name: str
    kind: ComponentType
    values: Mapping[str, Any]
    pose: Pose
    optic: Optic
    unseen: Unseen = SEEN

    @property
    def axes(self) -> tuple[Vector, Vector, Vector]:
        """The component's own directions in the table frame: ahead, left, up."""
        if self.unseen.displaced:
            ahead, left, up = (self.unseen.point(self.pose, way) for way in _AXES)
            return np.array(ahead), np.array(left), np.array(up)
        turned = math.radians(self.pose.yaw)
        c, s = math.cos(turned), math.sin(turned)
        return np.array([c, s, 0.0]), np.array([-s, c, 0.0]), np.array([0.0, 0.0, 1.0])

    @property
    def center(self) -> Vector:
        """The middle of its clear aperture (3,) [mm]; of its optical frame where it has none."""
        return self.origin if self.optic.center is None else np.array(self.optic.center)

    @property
    def origin(self) -> Vector:
        """Where its optical axis meets it (3,) [mm]."""
        x, y, z = self.kind.frames.optical
        if self.unseen.displaced:
            return np.array(self.unseen.place(self.pose, (x, y, z), (x, y, z)))
        return np.array([*self.pose.apply(x, y), z])

    def number(self, parameter: str, unit: str, otherwise: float) -> float:
        """Return a parameter in a unit, or what holds where its type does not say."""
        found = self.kind.number(parameter, unit)
        return otherwise if found is None else found

    def word(self, parameter: str, otherwise: str) -> str:
        """Return a parameter that is a word."""
        found = self.kind.parameters.get(parameter)
        return otherwise if found is None else str(found.value)

    def value(self, tunable: str, unit: str, otherwise: float) -> float:
        """Return a tunable in a unit; what holds otherwise where nobody knows it, or there is none."""
        found, kind = self.values.get(tunable), self.kind.tunables.get(tunable)
        if kind is None or isinstance(found, bool | str) or found is None:
            return otherwise
        try:
            return float(found) if kind.unit in ("", unit) else convert(f"{found} {kind.unit}", unit)
        except QuantityError:
            return otherwise

    def plane(self, ahead: float = 0.0, *, before: float = 1.0, after: float = 1.0) -> Surface:
        """Return the plane across its axis, so far ahead of its center [mm]."""
        along = self.axes[0]
        return Surface(self.center + ahead * along, along, before=before, after=after)


_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True, eq=False)
class Met:
    """What became of a beam at an element: `came`, as it arrives at its plane; those that go on; which share of the
    power its edge stopped; `event` where that is not what geometry alone says."""

    came: Beam
    onward: tuple[Beam, ...] = ()
    clipped: float = 0.0
    event: Event | None = None


class Element(Protocol):
    """A file of `pico.optics.elements`, named after the element."""

    def meet(self, part: Part, beam: Beam) -> Met:
        """Return what becomes of a beam that comes to a component within its clear aperture."""
        ...


class Straying(Element, Protocol):
    """A file of an element that sends beams astray, too; see `pico.optics.strays`."""

    def strays(self, part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
        """Return the beams that a component sends astray of one that it has met, beside those of `met`."""
        ...


def side(part: Part, at: Vector) -> float:
    """Return 1 for a point (3,) [mm] to the left of a component's axis, seen along the light, -1 to its right."""
    return 1.0 if float((at - part.origin) @ part.axes[1]) >= 0 else -1.0


def arrived(part: Part, beam: Beam, *, at: Vector | None = None, normal: Vector | None = None) -> Beam:
    """Return a beam where its chief ray meets the plane of an element: that across its axis through its center."""
    across = part.axes[0] if normal is None else normal
    middle = part.center if at is None else at
    return forward(beam, float((middle - beam.at) @ across) / float(beam.along @ across))


def clipped(part: Part, came: Beam, radius: float, *, center: Vector | None = None) -> tuple[Beam, float]:
    """Return a beam behind a round edge of a radius [mm], and the share that it stops. A beam that comes aslant sees it
    as an ellipse; but for a cube, which is as open on each side.

    What passes is its part within the edge; where that is less than SPOT of it, its spot is not Gaussian any
    more and becomes unknown: diffraction would have to tell.
    """
    middle = part.center if center is None else center
    aslant = came.frame @ np.array(part.optic.normal)
    seen, place = came, came.frame @ (middle - came.at)
    if not geometry_of(part.optic.element).cube and (size := float(np.hypot(*aslant))) > _SQUARE:
        # stretched along the tilt, so that the ellipse is the circle again
        stretch = np.eye(2) + (1 / math.sqrt(max(1 - size**2, 1e-12)) - 1) * np.outer(aslant, aslant) / size**2
        back = np.asarray(np.linalg.inv(stretch), dtype=np.float64)
        seen, place = stretched(came, back), stretch @ place
    passed = within(seen, place, radius)
    if passed >= 1.0:
        return came, 0.0
    behind = scaled(came, math.sqrt(passed))
    if passed < SPOT and not came.unknown:
        text = f"{part.name} lets only {100 * passed:.2g} % of the beam through, and its spot is diffraction's then"
        behind = replace(behind, unknown=text)
    return behind, 1.0 - passed


_SQUARE = 1e-6  # sine of the incidence from which an aperture counts as tilted


def stretched(beam: Beam, back: NDArray[np.float64]) -> Beam:
    """Return a beam in transverse coordinates u of which its own are `back` u (2, 2): as strong, of another shape."""
    waves = tuple(Wave(wave.field, back @ wave.shift, wave.group) for wave in beam.waves)
    return replace(beam, curvature=back @ beam.curvature @ back, waves=waves)


def within(beam: Beam, middle: Vector, radius: float) -> float:
    """Return the share of a beam's power that lies within a circle around `middle` (2,) [mm] from its chief ray, all
    its waves counted: by Gauss and Legendre along both principal axes, to 1e-9."""
    wide, narrow, angle = beam.widths
    if radius - float(np.hypot(*middle)) > _WINGS * wide:
        return 1.0
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    x, y = turn @ middle
    low, high = max(y - radius, -_WINGS * narrow), min(y + radius, _WINGS * narrow)
    if low >= high:
        return 0.0
    # over the angle t in y + radius sin t, in which the edge of the circle has no upright ends
    first, last = (math.asin(max(-1.0, min(1.0, (end - y) / radius))) for end in (low, high))
    nodes, weights = _legendre()
    t = (last + first) / 2 + (last - first) / 2 * nodes
    half = radius * np.cos(t)
    if _is_gaussian(beam):
        strip = _strip(x, half, wide) * np.exp(-2 * ((y + radius * np.sin(t)) / narrow) ** 2)
        return min(1.0, float((last - first) / 2 * (weights * strip * half).sum()) / (narrow * math.sqrt(math.pi / 2)))
    left, right = np.maximum(x - half, -_WINGS * wide), np.minimum(x + half, _WINGS * wide)
    reach = np.maximum(right - left, 0.0) / 2
    across = ((left + right) / 2)[:, None] + reach[:, None] * nodes
    up = np.broadcast_to((y + radius * np.sin(t))[:, None], across.shape)
    at = np.stack((turn[0, 0] * across + turn[1, 0] * up, turn[0, 1] * across + turn[1, 1] * up))
    strip = reach * (_irradiance(beam, at) @ weights)
    return min(1.0, float((last - first) / 2 * (weights * strip * half).sum()) / beam.power)


def _is_gaussian(beam: Beam) -> bool:
    """Return whether the irradiance of a beam is one Gaussian: no waves of a group are shifted against one another."""
    first: dict[Any, NDArray[np.complex128]] = {}
    return all(bool((wave.shift == first.setdefault(wave.group, wave.shift)).all()) for wave in beam.waves)


def _strip(x: float, half: NDArray[np.float64], wide: float) -> NDArray[np.float64]:
    """Return the share of a Gaussian of radius `wide` (of 1/e2) within `half` (n,) of `x` each: by error functions."""
    scale = math.sqrt(2) / wide
    return np.array([(math.erf((x + h) * scale) - math.erf((x - h) * scale)) / 2 for h in half.tolist()])


def _ripple(by: NDArray[np.complex128], at: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return the phase factor of a wave shifted `by` (2,) [rad/mm] at points (2, ...) [mm]; written out, as the threads
    of a matrix product cost more than it does."""
    if not by.any():
        return np.ones(at.shape[1:], dtype=np.complex128)
    return np.asarray(np.exp(1j * (by[0] * at[0] + by[1] * at[1])))


_WINGS = 4.0
"""Radii of a Gaussian beyond which there is nothing, to 1e-13 of it."""


@cache
def _legendre() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    nodes, weights = np.polynomial.legendre.leggauss(64)
    return nodes, weights


def _irradiance(beam: Beam, at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the irradiance [mW/mm2] at points (2, ...) [mm] of its transverse plane."""
    k, shape = beam.wave_number, np.imag(beam.curvature)
    found = np.zeros(at.shape[1:])
    for group in groups_of(beam):
        mine = (w for w in beam.waves if w.group == group)
        field = sum(np.multiply.outer(w.field, _ripple(k * w.shift, at)) for w in mine)
        found += (np.abs(field) ** 2).sum(axis=0)
    (xx, xy), (_, yy) = shape.tolist()
    spot = np.exp(-k * (xx * at[0] ** 2 + 2 * xy * at[0] * at[1] + yy * at[1] ** 2))
    whole: NDArray[np.float64] = k * math.sqrt(np.linalg.det(shape)) / math.pi * spot * found
    return whole
