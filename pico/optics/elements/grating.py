"""A reflection grating with upright lines, ruled on the face that looks along local -x."""

from __future__ import annotations

import math

from pico.optics.beam import Beam, scaled
from pico.optics.geometry import ORDERS
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.ramps import ramped


def meet(part: Part, beam: Beam) -> Met:
    """Send a beam into the orders of which the type has an efficiency, by the grating equation: with `lines` per mm g,
    sin(out) = sin(in) + m g wavelength, seen along local left. `efficiency_0`, `efficiency_plus_1` and
    `efficiency_minus_1` are shares of the power, of either polarization and at any angle: of a real one they hold near
    those for which they were measured. An order that can't leave has none, and the others get no more for it."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    normal, left, _ = part.axes
    period = part.number("lines", "1/mm", 0.0) * beam.wavelength
    found = []
    for name, order in ORDERS.items():
        share = part.number(name, "", 0.0)
        if share > 0:
            found.append(ramped(scaled(passed, math.sqrt(share)), normal, order * period * left, reflect=True))
    return Met(came, tuple(b for b in found if b is not None), lost)
