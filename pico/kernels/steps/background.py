"""Takes the background off a frame: a plane, by its corners."""

from __future__ import annotations

from dataclasses import replace

from pico.kernels.frame import Frame

VERSION, TAKES, GIVES = "1", "frame", "frame"


def run(frame: Frame) -> Frame:
    """Return the frame without its background; what was saturated stays so."""
    from pico.kernels import moments

    h, w = frame.pixels.shape
    plane, _ = moments.background(frame)
    flat = moments.flattened(frame, slice(0, h), slice(0, w), plane)
    return replace(frame, pixels=flat, full=frame.saturated, flat=True, black_level=0.0)
