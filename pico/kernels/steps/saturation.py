"""How near a frame is to what its camera can tell."""

from __future__ import annotations

from pico.kernels.frame import Frame, Result

VERSION, TAKES, GIVES = "1", "frame", {"pixels": "", "level": ""}


def run(frame: Frame) -> Result:
    """Return how many `pixels` read full scale, and at which share of it the brightest is (`level`)."""
    level = float(frame.pixels.max()) / frame.full_scale
    return Result({"pixels": float(frame.saturated), "level": level}, {"pixels": 0.0, "level": 0.0}, GIVES)
