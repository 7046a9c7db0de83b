"""The light of a beam: what the camera counts above the background, for one millisecond at a gain of 0 dB."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image", units={"power": "count/ms"})


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return the sum over the region of integration of `pico.kernels.spot`, by exposure and gain [count/ms]."""
    from pico.kernels.spot import spot

    beam = spot(given)
    if isinstance(beam, str):
        return Result(unknown=beam)
    scale = given.exposure * 10 ** (given.gain / 20)
    return Result({"power": beam.total / scale}, {"power": math.sqrt(beam.covariance[0, 0]) / scale})
