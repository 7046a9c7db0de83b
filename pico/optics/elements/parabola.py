"""An off-axis parabolic mirror: what comes along its axis goes to its focus, and back."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, beyond, scaled
from pico.optics.elements.mirror import amplitudes, strays
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import Vector
from pico.optics.rays import Surface

__all__ = ["meet", "strays"]


def meet(part: Part, beam: Beam) -> Met:
    """Reflect a beam off the paraboloid whose axis is local x and whose focus stands `focal_length` from the middle of
    its aperture, `fold` degrees from local +x: r = 2 f / (1 + cos phi) with the parent's focal length f, phi the angle
    between the way to the focus and local -x. Where it meets, its normal and both curvatures are those of the surface
    itself, so that a beam beside the axis or aslant gets its astigmatism."""
    came = arrived(part, beam, normal=np.array(part.optic.normal))
    passed, lost = clipped(part, came, part.optic.radius)
    axis, vertex, parent = _paraboloid(part)
    at = _met(part, beam, axis, vertex, parent)
    if at is None:
        return Met(came, clipped=1.0, event="blocked")
    across = (at - vertex) - ((at - vertex) @ axis) * axis
    gradient = 2 * across - 4 * parent * axis  # of |across|^2 - 4 f z, to the outside
    size = float(np.linalg.norm(gradient))
    inward = -gradient / size
    bend = 2 * (np.eye(3) - np.outer(axis, axis)) / size
    surface = Surface(at, inward, form=bend)
    sent = beyond(scaled(beam, math.sqrt(1 - lost)), surface, reflect=True, amplitudes=amplitudes(part))
    return Met(came, (replace(sent, unknown=passed.unknown),) if sent else (), lost)


def _paraboloid(part: Part) -> tuple[Vector, Vector, float]:
    """Return the axis from the vertex to the focus, the vertex [mm], and the focal length of the parent [mm]."""
    ahead, normal = part.axes[0], np.array(part.optic.normal)
    onward = ahead - 2 * (ahead @ normal) * normal
    reflected = part.number("focal_length", "mm", 100.0)
    parent = reflected * (1 - float(onward @ ahead)) / 2
    return -ahead, part.center + reflected * onward + parent * ahead, parent


def _met(part: Part, beam: Beam, axis: Vector, vertex: Vector, parent: float) -> Vector | None:
    """Return where a chief ray meets a paraboloid (3,) [mm], of two places that nearer to the mirror; None where it
    misses."""
    offset = beam.at - vertex
    z, dz = float(offset @ axis), float(beam.along @ axis)
    rho, drho = offset - z * axis, beam.along - dz * axis
    # |rho + t drho|^2 = 4 f (z + t dz)
    a, b, c = float(drho @ drho), float(rho @ drho) - 2 * parent * dz, float(rho @ rho) - 4 * parent * z
    square = b**2 - a * c
    if square < 0:
        return None
    stable = -b - math.copysign(math.sqrt(square), b)
    ways = [c / stable] if stable else []
    ways += [stable / a] if a > _PARALLEL else []
    places = [beam.at + far * beam.along for far in ways]
    return min(places, key=lambda at: float(np.linalg.norm(at - part.center)), default=None)


_PARALLEL = 1e-18
"""Square of the sine to the axis below which a ray meets a paraboloid once."""
