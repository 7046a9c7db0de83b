"""A chopper: its blades let a beam through, stop it, or turn and do both in turn."""

from __future__ import annotations

import math

from pico.optics.beam import Beam, scaled
from pico.optics.part import Met, Part, arrived, clipped


def meet(part: Part, beam: Beam) -> Met:
    """Pass a beam while the tunable `blades` says open, stop it while it says closed; `turning` passes the share `duty`
    of it in the mean, which is all that is known here: nothing tells one moment from another."""
    came = arrived(part, beam)
    blades = part.values.get("blades", "turning")
    if blades == "closed":
        return Met(came, clipped=1.0, event="blocked")
    passed, lost = clipped(part, came, part.optic.radius)
    share = 1.0 if blades == "open" else part.number("duty", "", 0.5)
    return Met(came, (scaled(passed, math.sqrt(share)),), 1 - (1 - lost) * share)
