"""The middle of a beam: first moments over the region of ISO 11146, see `pico.kernels.spot`."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image", units={"x": "um", "y": "um"})


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return x and y [um] from the middle of the sensor."""
    from pico.kernels.spot import spot

    beam = spot(given)
    if isinstance(beam, str):
        return Result(unknown=beam)
    x, y = given.at(float(beam.moments[0]), float(beam.moments[1]))
    across, down = (math.sqrt(beam.covariance[i, i]) * given.pixel_size for i in (1, 2))
    return Result({"x": x, "y": y}, {"x": across, "y": down})
