"""Two arms of the same length: where the fringes of a source with a spectrum are clearest."""

from __future__ import annotations

import math

from pico.bench.ready.tuning import ALONG, tuned
from pico.model.goal import Budget, Goal
from pico.planning.asked import Asked, Ready
from pico.planning.nominal_arms import CLEAR, VISIBILITY, met

TAKES = "STAGE CAMERA: arms as long as one another, where fringes are clearest"
LEAST = 2
_MOST = 3000
"""Measurements, most of them in search of fringes: those of white light are some micrometres of path wide, and parts
that are put down make arms longer by a thousand."""


def make(asked: Asked) -> Ready:
    """Return the goal of what makes an arm longer, and the camera that sees the fringes."""
    tunables, camera = tuned(asked, ALONG), asked.camera(asked.words[-1], VISIBILITY[1:])
    ways = asked.ways(camera)
    if len(ways) != 2:
        text = f"{len(ways)} beams come to {camera}, not those of two arms"
        raise asked.refused(text, "`pico beam` shows where beams run")
    inside = [sum(address.partition(".")[0] in way for way in ways) for address in tunables]
    if len(tunables) != 1 or inside[0] != 1:
        text = f"{' and '.join(tunables)}: it takes one tunable that makes one arm longer than the other"
        raise asked.refused(text, "a stage or a piezo in one arm, as `delay.stage_x`")
    _refuse_what_shows_nothing(asked, camera)
    clear = f"{camera}{VISIBILITY}"
    budget = Budget(measurements=_MOST, seconds=4.0 * _MOST)
    return Ready(asked.name, Goal(tunables=tunables, maximize=clear, signal=clear, least=CLEAR, budget=budget))


def _refuse_what_shows_nothing(asked: Asked, camera: str) -> None:
    """Raise PicoError where fringes tell nothing of the length of arms, or are too faint to be seen."""
    there = met(asked.setup, asked.seen, camera)
    if there is None:
        raise asked.refused(f"no two beams of one source meet on {camera}", "`pico beam` shows where beams run")
    if not math.isfinite(there.length):
        text = "light of a single frequency shows its fringes whatever the lengths of its arms"
        raise asked.refused(text, "a source with a spectrum (`optics: lines`), as `white_light_source`")
    if there.contrast <= CLEAR:
        text = f"as the beams meet on {camera}, fringes would have a visibility of {there.contrast:.1g} at most"
        raise asked.refused(text, "`overlap` brings one on the other; they should cross at a small angle")
