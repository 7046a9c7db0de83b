"""A neutral density filter: it takes the same share of all polarizations."""

from __future__ import annotations

from pico.optics.beam import Beam, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plates import plate
from pico.optics.strays import of_plate


def meet(part: Part, beam: Beam) -> Met:
    """Weaken a beam by ten to the power of minus `optical_density`, a tunable or a parameter."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    density = part.value("optical_density", "", part.number("optical_density", "", 0.0))
    return Met(came, plate(part, scaled(passed, 10 ** (-density / 2))), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what its faces send back."""
    return of_plate(part, met)
