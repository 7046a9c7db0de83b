"""A beam block: the end of a beam."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived


def meet(part: Part, beam: Beam) -> Met:
    """End a beam."""
    return Met(arrived(part, beam), event="blocked")
