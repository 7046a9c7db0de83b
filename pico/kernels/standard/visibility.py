"""How clear fringes are, by demodulating them at their own carrier: the brightest and the darkest pixel would tell the
noise, too."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image", units={"visibility": "1", "period": "um", "angle": "deg"})
_FEWEST = 3.0
"""Fringes across the light below which they can't be told from the beam's own shape."""
_SIGNIFICANT = 7.0
"""Standard deviations of a line: of the millions of frequencies of mere noise the strongest has 5 to 6."""


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return the visibility (greatest less least light, to their sum; 0 to 1), the period [um], and the direction in
    which the light goes up and down [deg, counter-clockwise from x, -90 to 90].

    Of light B (1 + V cos(k r)) with B smooth, V is twice the transform at k to that at 0, both with a Hann window.
    Fringes of a few pixels lose some of it to the size of the pixels: that is the visibility on the sensor.
    """
    import numpy as np

    from pico.kernels.fringes import fringes

    if why := given.refusal:
        return Result(unknown=why)
    signal = given.signal.astype(np.float64)
    found = fringes(signal, np.maximum(signal, 0) / given.electrons_per_count + given.dark_variance, _FEWEST)
    if found is None:
        return Result(unknown="there is no light above black")
    noise, visibility = 2 * found.noise / found.light, 2 * found.amplitude / found.light
    if visibility < _SIGNIFICANT * noise:
        return Result(unknown=f"there are no fringes of a visibility above {_SIGNIFICANT * noise:.2g}")
    if visibility > 1 + _SIGNIFICANT * noise:
        return Result(unknown="the light goes up and down by more than there is: the black level is wrong")
    frequency = math.hypot(*found.frequency)
    angle = math.degrees(math.atan2(found.frequency[1], found.frequency[0]))
    period = given.pixel_size / frequency
    return Result(
        {"visibility": min(visibility, 1.0), "period": period, "angle": angle},
        {
            "visibility": noise * math.sqrt(1 + visibility**2 / 2),
            "period": period * found.spread[0] / frequency,
            "angle": math.degrees(found.spread[1] / frequency),
        },
    )
