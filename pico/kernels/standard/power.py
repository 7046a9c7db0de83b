"""The light of a beam: what the camera counts above the background, for one millisecond at a gain of 0 dB."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image", units={"power": "count/ms"})


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return the sum over the region of integration of `pico.kernels.spot`, by exposure and gain [count/ms].

    No light is a number, too: the sum over the middle of the frame above what lies around it, and its deviation."""
    from pico.kernels.spot import spot
    from pico.kernels.start import is_dark, without_light

    scale = given.exposure * 10 ** (given.gain / 20)
    beam = spot(given)
    if isinstance(beam, str) and is_dark(beam):
        total, sigma = without_light(given)
        return Result({"power": total / scale}, {"power": sigma / scale})
    if isinstance(beam, str):
        return Result(unknown=beam)
    return Result({"power": beam.total / scale}, {"power": math.sqrt(beam.covariance[0, 0]) / scale})
