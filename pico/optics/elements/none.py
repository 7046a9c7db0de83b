"""What has a window and does nothing to light that passes it."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped


def meet(part: Part, beam: Beam) -> Met:
    """Pass what lies within the window."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    return Met(came, (passed,), lost)
