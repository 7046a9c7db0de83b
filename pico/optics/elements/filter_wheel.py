"""A wheel of neutral density filters, of which one stands in the beam."""

from __future__ import annotations

from dataclasses import replace

from pico.optics.beam import Beam, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plates import plate


def meet(part: Part, beam: Beam) -> Met:
    """Weaken a beam by ten to the power of minus `density_N` where the tunable `position` is `at_N`. Where nobody knows
    its position it weakens nothing, so that nothing behind it is thought safe that is not, and its spot is unknown."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    position = part.values.get("position")
    if not isinstance(position, str):
        why = passed.unknown or f"nobody knows which filter of {part.name} stands in the beam"
        return Met(came, plate(part, replace(passed, unknown=why)), lost)
    density = part.number(position.replace("at", "density", 1), "", 0.0)
    return Met(came, plate(part, scaled(passed, 10 ** (-density / 2))), lost)
