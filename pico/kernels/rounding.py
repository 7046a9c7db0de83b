"""What rounding to whole counts makes of light that is dimmer than a count: noise of half a count or more spreads it
over two counts and nothing is lost, less noise does not. Needs numpy at its top: kernels import it inside their
functions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import Plane
from pico.kernels.frame import Frame

Array = NDArray[np.float64]
_QUIET = 0.6
"""Counts of noise from which rounding changes the mean by less than 0.0003 counts."""
_PHASES = 32
"""Levels of the background within a count that are looked at."""
_ALIKE = 0.03
"""Counts by which the background that a level makes may differ from the measured one."""
_DIMMEST, _STEPS = 1e-3, 300


def levels(frame: Frame, behind: Plane, offset: float) -> Array:
    """Return the levels [count] that the background may have within a count, by what it reads: `offset` off the plane;
    none where rounding does no harm."""
    deviation = frame.read_noise / frame.electrons_per_count or math.sqrt(max(behind.variance - 1 / 12, 0.0))
    if frame.pixels.dtype.kind == "f" or frame.dark is not None or deviation > _QUIET:
        return np.empty(0)
    some = (np.arange(_PHASES) + 0.5) / _PHASES
    reads = some + _shift(some, np.full(_PHASES, deviation**2))
    off = reads - (frame.black_level + behind.level + offset)
    apart = np.abs(off - np.round(off))
    return some[apart <= max(_ALIKE, float(apart.min()))]


def shifts(light: Array, frame: Frame, level: float, spread: Array | float = 0.0) -> Array:
    """Return by how much rounding changes the mean of light on a background of a level, above that of the background
    [count]. `spread`: variance of the light over what is averaged [count^2]."""
    deviation = frame.read_noise / frame.electrons_per_count
    variance = deviation**2 + np.maximum(light, 0) / frame.electrons_per_count + spread
    zero = _shift(np.array([level]), np.array([deviation**2]))
    found: Array = _shift(level + light, variance) - zero
    return found


def change(frame: Frame, behind: Plane, offset: float, total: float, moments: Array) -> Array:
    """Return the covariance (6, 6) that rounding adds to total and moments of a Gaussian beam: area between two lines
    of equal light goes as the logarithm of the light."""
    some = levels(frame, behind, offset)
    root = math.sqrt(max(float(moments[2] * moments[3] - moments[4] ** 2), 1e-9))
    peak = total / (2 * math.pi * root)
    out = np.zeros((6, 6))
    if not len(some) or peak <= _DIMMEST:
        return out
    logs = np.linspace(math.log(_DIMMEST), math.log(peak), _STEPS)
    light, each = np.exp(logs), (logs[1] - logs[0]) / peak
    for level in some:
        off = shifts(light, frame, float(level), (light * (logs[1] - logs[0])) ** 2 / 12) * each
        wider = float(off @ (math.log(peak) - logs - 1))
        vector = np.array([float(off.sum()) * total, 0, 0, *(wider * moments[2:])])
        out += np.outer(vector, vector) / len(some)
    return out


def _shift(values: Array, variance: Array) -> Array:
    """By how much the mean of rounded values is off: the series of a saw tooth, which noise of a variance blurs."""
    out = np.zeros_like(values)
    for k in (1, 2, 3):
        sign = 1 if k % 2 == 0 else -1
        out += sign * np.exp(-2 * (math.pi * k) ** 2 * variance) * np.sin(2 * math.pi * k * values) / (math.pi * k)
    return out
