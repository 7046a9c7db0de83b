"""A spot in the middle of a camera."""

from __future__ import annotations

from pico.bench.ready.tuning import ACROSS, tuned
from pico.model.goal import Goal
from pico.planning.asked import Asked, Ready

TAKES = "PART... CAMERA: its spot in the middle of the camera, to 5 um"
LEAST = 2
ANYWHERE = True
NEAR = 5.0
"""How near the middle is near enough [um]."""


def make(asked: Asked) -> Ready:
    """Return the goal of parts and the camera that sees it."""
    tunables, camera = tuned(asked, ACROSS), asked.camera(asked.words[-1])
    wanted = {f"{camera}.centroid.{axis}": 0.0 for axis in ("x", "y")}
    return Ready(asked.name, Goal(tunables=tunables, reach=wanted, tolerance=NEAR))
