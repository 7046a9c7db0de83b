"""The centroid of a spot: its first moments, see `pico.kernels.moments`."""

from __future__ import annotations

import math

from pico.kernels.frame import Frame, Result

VERSION, TAKES, GIVES = "1", "frame", {"x": "um", "y": "um"}


def run(frame: Frame) -> Result:
    """Return x and y [um] from the middle of the sensor, to the right and up."""
    from pico.kernels import moments

    spot = moments.find(frame)
    if isinstance(spot, Result):
        return spot
    x, y = moments.placed(frame, spot.x, spot.y)
    of = moments.variances(frame, spot)
    sigma = {"x": math.sqrt(of[0]) * frame.pixel_size, "y": math.sqrt(of[1]) * frame.pixel_size}
    return Result({"x": x, "y": y}, sigma, GIVES)
