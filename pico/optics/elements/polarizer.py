"""A polarizer, turned about its axis by the tunable `angle`, and tilted as it stands."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import cast

import numpy as np

from pico.optics.beam import Beam, beyond, scaled
from pico.optics.part import Met, Part, arrived, clipped
from pico.optics.plane_waves import Substrate, linear, polarized
from pico.optics.plates import plate
from pico.optics.rays import Surface
from pico.optics.strays import astray, of_plate, passing


def meet(part: Part, beam: Beam) -> Met:
    """Pass what is polarized along its axis: 0 deg is level, counter-clockwise seen against local +x."""
    came = arrived(part, beam)
    passed, lost = clipped(part, came, part.optic.radius)
    along, left, up = part.axes
    angle = math.radians(part.value("angle", "deg", part.number("angle", "deg", 0.0)))
    absorbs = math.cos(angle) * up - math.sin(angle) * left
    why = linear(passed, along)
    extinction = 1 / (1 / part.number("extinction", "", math.inf) + part.unseen.leak) if part.unseen.leak else None
    behind = polarized(
        passed, along, absorbs, part.number("transmission", "", 1.0),
        part.number("extinction", "", math.inf) if extinction is None else extinction,
        cast(Substrate, part.word("substrate", "film")), part.number("refractive_index", "", 1.5),
    )  # fmt: skip
    if why and not behind.unknown:
        behind = replace(behind, unknown=f"{why}: what {part.name} makes of it is more than its axis turning evenly")
    return Met(came, plate(part, behind), lost)


def strays(part: Part, beam: Beam, met: Met) -> tuple[Beam, ...]:
    """Return what its faces send back, and where it says `rejected: reflected` what it does not pass, sent by `fold`
    degrees (90) to its left; a film absorbs that."""
    came = passing(met)
    lost = came.power - sum(b.power for b in met.onward)
    if part.word("rejected", "absorbed") != "reflected" or lost <= 0:
        return of_plate(part, met)
    facing = math.radians(part.pose.yaw + part.number("fold", "deg", 90.0) / 2 + 90.0)
    coating = Surface(part.center, np.array([math.cos(facing), math.sin(facing), 0.0]))
    sent = beyond(scaled(came, math.sqrt(lost / came.power)), coating, reflect=True)
    return (*of_plate(part, met), *astray(sent))
