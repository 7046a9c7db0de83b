"""A hollow roof: two upright mirrors at a right angle, which send a beam back beside the way that it came."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam
from pico.optics.geometry import half_turned
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import Vector

_CLEAR = 1.5
"""Radii of the beam that must be between it and the edge where the mirrors meet: beyond are 0.1 % of it."""


def meet(part: Part, beam: Beam) -> Met:
    """Send a beam back. Two mirrors at a right angle turn whatever comes by half a turn about their edge, its field as
    well; to the plane through the edge and back the ways of all rays are as long. Each takes 1 - `reflectance`."""
    normal = np.array(part.optic.normal)
    came = arrived(part, beam, normal=normal)
    passed, lost = clipped(part, came, part.optic.radius)
    field = part.number("reflectance", "", 1.0) * turned(np.ones(3))  # a perfect mirror, twice: as a direction turns
    waves = tuple(replace(w, field=field * w.field) for w in passed.waves)
    aside = float((came.at - part.center) @ np.array([-normal[1], normal[0], 0.0]))
    unknown = passed.unknown
    if abs(aside) < _CLEAR * came.widths[0] and not unknown:
        unknown = f"{part.name} meets it with the edge of its roof, and sends parts of it to two sides"
    sent = replace(
        passed, at=part.center + turned(passed.at - part.center), along=turned(passed.along),
        across=turned(passed.across), waves=waves, unknown=unknown,
    )  # fmt: skip
    return Met(came, (sent,), lost)


def turned(vector: Vector) -> Vector:
    """Return a vector (3,) by half a turn about the upright."""
    x, y, z = vector.tolist()
    return np.array(half_turned((x, y, z)))
