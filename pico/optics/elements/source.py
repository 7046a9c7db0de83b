"""A laser, where a beam comes back to it."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived


def meet(part: Part, beam: Beam) -> Met:
    """End a beam at the laser's window."""
    return Met(arrived(part, beam), event="blocked")
