"""What has a window and does nothing to light that passes it."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.strays import of_plate


def meet(part: Part, beam: Beam) -> Met:
    """Pass what lies within the window."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    return Met(came, (passed,), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what the faces of a window of glass send back: one whose type gives a `refractive_index`."""
    return of_plate(part, met) if "refractive_index" in part.kind.parameters else ()
