"""A shutter: open it lets a beam through, closed it ends it."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped


def meet(part: Part, beam: Beam) -> Met:
    """Pass a beam while the tunable `shutter` does not say closed."""
    came = arrived(part, beam)
    if part.values.get("shutter") == "closed":
        return Met(came, clipped=1.0, event="blocked")
    passed, lost = clipped(part, came, part.optic.radius)
    return Met(came, (passed,), lost)
