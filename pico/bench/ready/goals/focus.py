"""The smallest spot on a camera."""

from __future__ import annotations

from pico.bench.ready.tuning import ALONG, tuned
from pico.model.goal import Goal
from pico.planning.asked import Asked, Ready

TAKES = "PART... CAMERA: the smallest spot on the camera"
LEAST = 2
ANYWHERE = True


def make(asked: Asked) -> Ready:
    """Return the goal of parts and the camera that sees it."""
    tunables, camera = tuned(asked, ALONG), asked.camera(asked.words[-1], "width.major")
    return Ready(asked.name, Goal(tunables=tunables, minimize=f"{camera}.width.major"))
