"""An iris: what lies within its opening passes."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped


def meet(part: Part, beam: Beam) -> Met:
    """Stop what is beside the opening: a tunable, else the parameter `diameter`, else as wide as the clear aperture."""
    came = arrived(part, beam)
    opening = part.value("opening", "mm", part.number("diameter", "mm", 2 * part.optic.radius))
    passed, lost = clipped(part, came, opening / 2)
    return Met(came, (passed,), lost)
