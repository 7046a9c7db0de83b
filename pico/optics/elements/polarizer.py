"""A polarizer, turned about its axis by the tunable `angle`, and tilted as it stands."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import cast

from pico.optics.beam import Beam
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plane_waves import Substrate, linear, polarized
from pico.optics.plates import plate


def meet(part: Part, beam: Beam) -> Met:
    """Pass what is polarized along its axis: 0 deg is level, counter-clockwise seen against local +x."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    along, left, up = part.axes
    angle = math.radians(part.value("angle", "deg", part.number("angle", "deg", 0.0)))
    absorbs = math.cos(angle) * up - math.sin(angle) * left
    why = linear(passed, along)
    behind = polarized(
        passed, along, absorbs, part.number("transmission", "", 1.0), part.number("extinction", "", math.inf),
        cast(Substrate, part.word("substrate", "film")), part.number("refractive_index", "", 1.5),
    )  # fmt: skip
    if why and not behind.unknown:
        behind = replace(behind, unknown=f"{why}: what {part.name} makes of it is more than its axis turning evenly")
    return Met(came, plate(part, behind), lost)
