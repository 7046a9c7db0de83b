"""A shutter or a chopper: open it lets a beam through, closed it ends it."""

from __future__ import annotations

import math

from pico.optics.beam import Beam, scaled
from pico.optics.part import Met, Part, arrived, clipped


def meet(part: Part, beam: Beam) -> Met:
    """Pass a beam while the tunable `shutter` does not say closed; of a chopper `blades`, where `turning` passes the
    share `duty` of it in the mean, which is all that is known here: nothing tells one moment from another."""
    came = arrived(part, beam)
    blades = part.values.get("blades", "turning") if "blades" in part.kind.tunables else "open"
    if part.values.get("shutter") == "closed" or blades == "closed":
        return Met(came, clipped=1.0, event="blocked")
    passed, lost = clipped(part, came, part.optic.radius)
    share = 1.0 if blades == "open" else part.number("duty", "", 0.5)
    return Met(came, (scaled(passed, math.sqrt(share)),), 1 - (1 - lost) * share)
