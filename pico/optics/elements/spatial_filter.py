"""A spatial filter: a lens, a pinhole in its focus, and a lens that makes the beam parallel again, as one part."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, forward, scaled
from pico.optics.elements.lens import thin
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import Vector


def meet(part: Part, beam: Beam) -> Met:
    """Send a beam along local +x through a thin lens of `focal_length`, a pinhole of `pinhole` in its focus, moved by
    the tunables `pinhole_y` and `pinhole_z` across the light, and a thin lens of `focal_length_out`; the other way
    round what comes the other way. The pinhole takes from a Gaussian beam what lies beside it, and its spot is unknown
    where that is more than a tenth: diffraction would have to tell. So are beams that are not Gaussian to begin with,
    which this is there to clean: in the light model every beam is."""
    first, last = part.number("focal_length", "mm", 10.0), part.number("focal_length_out", "mm", 50.0)
    ahead, left, up = part.axes
    axis = ahead if beam.along @ ahead > 0 else -ahead
    entry, leaves = part.center - (first + last) / 2 * ahead, part.center + (first + last) / 2 * ahead
    hole = entry + first * ahead
    hole = hole + part.value("pinhole_y", "mm", 0.0) * left + part.value("pinhole_z", "mm", 0.0) * up
    if axis is not ahead:
        first, last, entry, leaves = last, first, leaves, entry
    came = arrived(part, beam, at=entry, normal=ahead)
    passed, lost = clipped(part, came, part.optic.radius, center=entry)
    inside = _through(part, passed, entry, axis, first)
    inside = forward(inside, float((hole - inside.at) @ axis) / float(inside.along @ axis))
    behind, stopped = clipped(part, inside, part.number("pinhole", "mm", 0.02) / 2, center=hole)
    behind = forward(behind, float((leaves - behind.at) @ axis) / float(behind.along @ axis))
    out = _through(part, behind, leaves, axis, last)
    unknown = beam.unknown or out.unknown
    share = math.sqrt(part.number("transmission", "", 1.0))
    return Met(came, (replace(scaled(out, share), unknown=unknown),), 1 - (1 - lost) * (1 - stopped))


def _through(part: Part, beam: Beam, center: Vector, axis: Vector, focal: float) -> Beam:
    _, left, up = part.axes
    return thin(beam, center, axis, (np.outer(left, left) + np.outer(up, up)) / focal)
