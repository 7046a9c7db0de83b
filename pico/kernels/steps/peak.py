"""The brightest place of a frame, above its background."""

from __future__ import annotations

import math

from pico.kernels.frame import Frame, Result, spoilt

VERSION, TAKES, GIVES = "1", "frame", {"peak": "count"}


def run(frame: Frame) -> Result:
    """Return the greatest mean of 3 x 3 pixels [count], so that one hot pixel is none, and noise hardly counts."""
    from pico.kernels import moments

    spoils = spoilt(frame)
    if spoils:
        return spoils
    import numpy as np

    plane, noise = moments.background(frame)
    h, w = frame.pixels.shape
    part = moments.flattened(frame, slice(0, h), slice(0, w), plane)
    if min(h, w) > 4:
        # the middle one of three along each axis first: what is alone is gone
        for axis in (0, 1):
            a, b, c = (np.take(part, range(n, part.shape[axis] - 2 + n), axis=axis) for n in range(3))
            part = np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))
    value = float(part.max())
    each = noise + max(value, 0.0) / frame.electrons_per_count
    return Result({"peak": value}, {"peak": math.sqrt(each / 3)}, GIVES)
