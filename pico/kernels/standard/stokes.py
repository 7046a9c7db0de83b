"""The Stokes parameters of light, from six powers behind analyzers."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.kernels.frame import Readings
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(version="1", takes="readings", units={"s1": "1", "s2": "1", "s3": "1", "polarization": "1"})
_PAIRS = (("across", "up"), ("diagonal", "antidiagonal"), ("positive", "negative"))
"""Behind an analyzer at 0 and 90 deg, at 45 and 135, and for S3 = +1 and -1, see `pico.optics.polarization`."""


def apply(given: Readings, parameters: Mapping[str, float]) -> Result:
    """Return S1 to S3 in units of S0 and the degree of polarization, from readings by the names in `_PAIRS`: each
    parameter is the difference of its two by their sum, so slow drift of the power between pairs does no harm. Noise
    may bring the degree above 1; it is not held back."""
    values, sigmas = (dict(zip(given.names, row, strict=False)) for row in (given.values, given.sigma))
    if missing := [name for pair in _PAIRS for name in pair if name not in values]:
        return Result(unknown=f"there is no reading `{missing[0]}`; expected {', '.join(n for p in _PAIRS for n in p)}")
    found, spread = [], []
    for plus, minus in _PAIRS:
        total = values[plus] + values[minus]
        if not total > 0:
            return Result(unknown=f"there is no light: `{plus}` and `{minus}` add up to {total:g}")
        found.append((values[plus] - values[minus]) / total)
        spread.append(2 * math.hypot(values[minus] * sigmas[plus], values[plus] * sigmas[minus]) / total**2)
    degree = math.hypot(*found)
    along = math.hypot(*(s * v for s, v in zip(found, spread, strict=True))) / degree if degree > 0 else max(spread)
    names = tuple(KERNEL.units)
    return Result(dict(zip(names, (*found, degree), strict=True)), dict(zip(names, (*spread, along), strict=True)))
