"""Where the components of a bench stand, straight from pictures."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from pico.model.setup import Setup
from pico.vision.calibration import Calibration
from pico.vision.frame import Frame
from pico.vision.localize import recognize, replace_dark
from pico.vision.markers import detect
from pico.vision.sighting import Sighting


def localize(setup: Setup, frames: Sequence[Frame], calibration: Calibration, held: Collection[str] = ()) -> Sighting:
    """Return what `recognize` makes of `frames`, one a camera. A black frame shows nothing and is said to."""
    dark = tuple(frame.camera for frame in frames if frame.black)
    seen = recognize(setup, [detect(frame) for frame in frames if not frame.black], calibration, held)
    return replace_dark(seen, dark)
