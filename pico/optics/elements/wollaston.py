"""A Wollaston prism: level and upright polarization leave on either side of its axis."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from pico.optics.beam import Beam
from pico.optics.geometry import wollaston_kicks
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.polarization import product
from pico.optics.ramps import ramped


def meet(part: Part, beam: Beam) -> Met:
    """Divide a beam: what is polarized level goes to the left, what is upright to the right, `divergence` apart. It is
    as thin as its middle, where the two part; of each the share `transmission` passes, 1 / `extinction` of the other
    polarization with it."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    normal, left, _ = part.axes
    share, leak = part.number("transmission", "", 1.0), 1 / part.number("extinction", "", math.inf)
    flat = left - (left @ came.along) * came.along
    flat = flat / np.linalg.norm(flat)
    ways = (flat, product(came.along, flat))
    # what leaks into one beam is missing in the other
    own, other = math.sqrt(share * (1 - leak)), math.sqrt(share * leak)
    found = []
    for mine, wrong, (always, _, _) in zip(ways, ways[::-1], wollaston_kicks(part.kind), strict=True):
        waves = (
            replace(w, field=own * (w.field @ mine) * mine + other * (w.field @ wrong) * wrong) for w in passed.waves
        )
        kept = tuple(w for w in waves if np.abs(w.field).max() > 0)
        if kept:
            found.append(ramped(replace(passed, waves=kept), normal, always * left))
    return Met(came, tuple(b for b in found if b is not None and b.power > 0), lost)
