"""As much light as can be."""

from __future__ import annotations

from pico.bench.ready.tuning import ACROSS, tuned
from pico.model.goal import Goal
from pico.planning.asked import Asked, Ready

TAKES = "PART... DETECTOR: as much light as can be"
LEAST = 2
ANYWHERE = True


def make(asked: Asked) -> Ready:
    """Return the goal of parts and the detector that sees it."""
    return Ready(asked.name, Goal(tunables=tuned(asked, ACROSS), maximize=asked.light_of(asked.words[-1])))
