"""What adds the same to every direction in its plane: gratings, and thin prisms such as Wollaston's."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics import gaussian
from pico.optics.beam import UP, Beam, level
from pico.optics.geometry import GRAZING
from pico.optics.polarization import Vector, joined, product, split


def ramped(came: Beam, normal: Vector, kick: Vector, *, reflect: bool = False) -> Beam | None:
    """Return a beam at a plane (its upright `normal`) behind a phase that rises evenly along it: `kick` (3,) is what
    that adds to the direction in the plane, m g wavelength for the order m of a grating with g lines. None where
    nothing leaves. The phase along the plane is linear, so the curvature is matched as at a plane surface: beams get
    wider or narrower in the plane of diffraction (anamorphic), as their waist does.

    The field turns with the direction, about the line across both; sent back, it is first that off a mirror.
    """
    facing = float(came.along @ normal)
    inside = came.along - facing * normal + kick
    square = 1 - float(inside @ inside)
    if square <= GRAZING:
        return None
    out = math.copysign(math.sqrt(square), -facing if reflect else facing)
    along = inside + out * normal
    start, flip = came.along, np.eye(3)
    if reflect:
        flip = np.eye(3) - 2 * np.outer(normal, normal)
        start = flip @ start
    s = product(start, along)
    size = float(np.linalg.norm(s))
    s = s / size if size > 1e-12 else level(along, came.across)
    tangent = product(UP, normal)
    tangent = tangent / np.linalg.norm(tangent)
    axes = np.stack([tangent, product(normal, tangent)])
    across = level(along, came.across)
    before, after = came.frame @ axes.T, np.stack([across, product(along, across)]) @ axes.T
    curvature = gaussian.through(came.curvature, before, after, (1, 1), (facing, out), np.zeros((2, 2)))
    back = np.linalg.inv(after).T @ before.T
    sign = -1.0 if reflect else 1.0  # a conductor turns the field in its plane round
    waves = tuple(
        replace(w, field=joined(*split(sign * (flip @ w.field), start, s), along, s), shift=back @ w.shift)
        for w in came.waves
    )
    return replace(came, along=along, across=across, curvature=curvature, waves=waves)
