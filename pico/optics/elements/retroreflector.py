"""A hollow corner cube: three mirrors at right angles, which send a beam back beside the way that it came."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped

_CLEAR = 1.5
"""Radii of the beam that must be between it and the corner: beyond are 1 % of it."""
_FLIPPED = np.diag([1.0, -1.0])


def meet(part: Part, beam: Beam) -> Met:
    """Send a beam back: three mirrors at right angles turn every direction round, and every point about the corner; to
    the plane through that and back the ways of all rays are as long. Perfect conductors leave the field as it is, so
    what comes back is polarized as what came; each takes 1 - `reflectance`."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    field = part.number("reflectance", "", 1.0) ** 1.5
    aside = came.frame @ (came.at - part.center)
    unknown = passed.unknown
    if float(np.hypot(*aside)) < _CLEAR * came.widths[0] and not unknown:
        unknown = f"{part.name} meets it with the edges of its mirrors, and sends parts of it to several sides"
    # what was to the right of the beam is so still, seen along it; what was above is below
    waves = tuple(replace(w, field=field * w.field, shift=_FLIPPED @ w.shift) for w in passed.waves)
    sent = replace(
        passed, at=2 * part.center - passed.at, along=-passed.along, curvature=_FLIPPED @ passed.curvature @ _FLIPPED,
        waves=waves, unknown=unknown,
    )  # fmt: skip
    return Met(came, (sent,), lost)
