"""A right-angle prism as a mirror: in at one leg, totally reflected at the long face, out at the other leg."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, beyond, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plates import faces
from pico.optics.rays import Surface

_GLASS = 1.5151


def meet(part: Part, beam: Beam) -> Met:
    """Send light that comes along local +x to the left, along +y, and the other way round. Its legs are `edge` long and
    coated, of `transmission` together; the long face is bare glass of `refractive_index`, which turns p against s by
    what Fresnel's equations say, and lets a part out where light comes to it too steeply for total reflection."""
    normal = np.array(part.optic.normal)
    came = arrived(part, beam, normal=normal)
    passed, lost = clipped(part, came, part.optic.radius)
    index, half = part.number("refractive_index", "", _GLASS), part.number("edge", "mm", 25.4) / 2
    ahead, left, _ = part.axes
    legs = [
        Surface(part.center - half * ahead, -ahead, before=index, after=1.0),
        Surface(part.center + half * left, left, before=index, after=1.0),
    ]
    enters, leaves = legs if beam.along @ ahead > -(beam.along @ left) else legs[::-1]
    long = Surface(part.center, normal, before=1.0, after=index)
    back, out = faces(index, 1.0)
    share = math.sqrt((1 - lost) * part.number("transmission", "", 1.0))
    inside = beyond(scaled(beam, share), enters)
    sent = inside and beyond(inside, long, reflect=True, amplitudes=back)
    sent = sent and beyond(sent, leaves)
    escaped = inside and beyond(inside, long, amplitudes=out)  # none where it is totally reflected
    found = tuple(replace(b, unknown=passed.unknown) for b in (sent, escaped) if b is not None)
    return Met(came, found, lost)
