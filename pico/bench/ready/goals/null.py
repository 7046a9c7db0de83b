"""As little light as can be: a polarizer crossed, a wave plate between polarizers that turns nothing."""

from __future__ import annotations

from pico.bench.ready.tuning import ACROSS, TURNED, tuned
from pico.model.goal import Goal
from pico.planning.asked import Asked, Ready

TAKES = "PART... DETECTOR: as little light as can be, by the angle of a polarizer or wave plate"
LEAST = 2
ANYWHERE = True


def make(asked: Asked) -> Ready:
    """Return the goal of parts and the detector that sees it."""
    return Ready(asked.name, Goal(tunables=tuned(asked, TURNED, ACROSS), minimize=asked.light_of(asked.words[-1])))
