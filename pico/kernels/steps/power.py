"""The power of a spot, in counts that it would give in a millisecond at a gain of 0 dB: comparable between frames."""

from __future__ import annotations

import math

from pico.kernels.frame import Frame, Result

VERSION, TAKES, GIVES = "1", "frame", {"power": "count/ms"}


def run(frame: Frame) -> Result:
    """Return the sum of a spot without its background, over exposure [ms] and gain; 0 with its uncertainty where
    nothing stands out of the noise."""
    from pico.kernels import moments

    spot = moments.find(frame)
    scale = 1 / frame.exposure / 10 ** (frame.gain / 20)
    if isinstance(spot, Result):
        if not spot.unknown.startswith("no light"):
            return spot
        plane, noise = moments.background(frame)
        sigma = math.sqrt(noise * frame.pixels.size + (plane.sigma[0] * frame.pixels.size) ** 2)
        return Result({"power": 0.0}, {"power": sigma * scale}, GIVES)
    sigma = math.sqrt(moments.variances(frame, spot)[4])
    return Result({"power": spot.total * scale}, {"power": sigma * scale}, GIVES)
