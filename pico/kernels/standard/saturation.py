"""How many pixels are saturated, which makes other kernels say nothing of the picture."""

from __future__ import annotations

from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="2", takes="image", units={"saturated": "pixel"})


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return the number of pixels that read full scale: a count, without uncertainty."""
    return Result({"saturated": float(given.saturated)}, {"saturated": 0.0})
