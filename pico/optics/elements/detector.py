"""A camera or a power meter: a beam ends on its sensor, at the origin of its optical frame."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped


def meet(part: Part, beam: Beam) -> Met:
    """Take a beam where it meets the sensor, after the clear aperture before it has stopped its part. The edge is close
    to the sensor: what it lets through is there as it came."""
    _, lost = clipped(part, arrived(part, beam), part.optic.radius)
    return Met(arrived(part, beam, at=part.origin), clipped=lost)
