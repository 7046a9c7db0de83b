"""A beam expander: a telescope that makes a beam wider along local +x, and narrower the other way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam, level, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.strays import of_plate


def meet(part: Part, beam: Beam) -> Met:
    """Widen a beam by `magnification` about the axis; slopes become less by as much, and the wavefront flatter by its
    square (ABCD matrix of an afocal telescope, [m 0; 0 1/m], at its middle: its own length counts as nothing)."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    axis = part.axes[0]
    forward = float(came.along @ axis) > 0
    wider = part.number("magnification", "", 1.0) ** (1 if forward else -1)
    straight = axis if forward else -axis
    slope = came.along / float(came.along @ straight) - straight
    along = straight + slope / wider
    along = along / np.linalg.norm(along)
    waves = tuple(replace(w, shift=w.shift / wider) for w in passed.waves)
    behind = replace(
        passed, at=part.center + wider * (came.at - part.center), along=along, across=level(along, came.across),
        curvature=passed.curvature / wider**2, waves=waves,
    )  # fmt: skip
    return Met(came, (scaled(behind, math.sqrt(part.number("transmission", "", 1.0))),), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what its faces send back."""
    return of_plate(part, met)
