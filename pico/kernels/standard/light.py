"""All the light on the sensor, as a power meter tells it: wherever the beam is, and where it leaves the frame, too."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image", units={"light": "count/ms"})


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return the sum of all pixels above black, by exposure and gain [count/ms]. A black level that is not known well
    counts with every pixel."""
    import numpy as np

    if why := given.refusal:
        return Result(unknown=why)
    total, scale = float(given.signal.sum(dtype=np.float64)), given.exposure * 10 ** (given.gain / 20)
    noise = max(total, 0.0) / given.electrons_per_count + given.pixels.size * given.dark_variance
    return Result({"light": total / scale}, {"light": math.sqrt(noise) / scale})
