"""A camera, a power meter, a fiber: a beam ends on its sensor, at the origin of its optical frame."""

from __future__ import annotations

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped, side


def meet(part: Part, beam: Beam) -> Met:
    """Take a beam where it meets the sensor, after the clear aperture before it has stopped its part. The edge is close
    to the sensor: what it lets through is there as it came. Of two diodes, `separation` apart, the nearer takes what
    falls within its own edge."""
    came = arrived(part, beam, at=part.origin)
    apart = part.number("separation", "mm", 0.0)
    if apart:
        middle = part.origin + side(part, came.at) * apart / 2 * part.axes[1]
        return Met(came, clipped=clipped(part, came, part.number("active_diameter", "mm", 1.0) / 2, center=middle)[1])
    return Met(came, clipped=clipped(part, arrived(part, beam), part.optic.radius)[1])
