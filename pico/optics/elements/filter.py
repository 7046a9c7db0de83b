"""A neutral density filter, or a wheel of them: it takes the same share of all polarizations."""

from __future__ import annotations

from dataclasses import replace

from pico.optics.beam import Beam, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plates import plate
from pico.optics.strays import of_plate


def meet(part: Part, beam: Beam) -> Met:
    """Weaken a beam by ten to the power of minus `optical_density`, a tunable or a parameter; of a wheel of
    `density_N` where its tunable `position` is `at_N`. Where nobody knows that, it weakens nothing, so that nothing
    behind it is thought safe that is not, and its spot is unknown."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    density = part.value("optical_density", "", part.number("optical_density", "", 0.0))
    if "position" in part.kind.tunables:
        position = part.values.get("position")
        if isinstance(position, str):
            density = part.number(position.replace("at", "density", 1), "", 0.0)
        else:
            why = passed.unknown or f"nobody knows which filter of {part.name} stands in the beam"
            passed = replace(passed, unknown=why)
    return Met(came, plate(part, scaled(passed, 10 ** (-density / 2))), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what its faces send back."""
    return of_plate(part, met)
