"""What rounding to whole counts makes of light that is dimmer than a count: noise of half a count or more spreads it
over two counts and nothing is lost, less noise does not. Needs numpy at its top: kernels import it inside their
functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import Plane
from pico.kernels.frame import Frame
from pico.kernels.stripes import Stripes

Array = NDArray[np.float64]
_QUIET = 0.6
"""Counts of noise from which rounding changes the mean by less than 0.0003 counts."""
_PHASES = (np.arange(32) + 0.5) / 32
"""Levels of the background within a count."""
_ALIKE = 0.03
"""Counts by which the background that a level makes may differ from the measured one."""
_EVEN = 0.03
"""Counts by which a background may vary over a beam that has one level within a count."""
_DIMMEST, _STEPS = 1e-3, 300
LIT = 0.3
"""Light [count] from which it spreads the background over two counts."""


@dataclass(frozen=True, eq=False)
class Rounding:
    """The fractions of a count at which the background may lie (`levels`); whether that varies across the beam
    (`uneven`); and `variance` [count^2] and electrons a count, by which noise spreads."""

    levels: Array
    uneven: bool
    variance: float
    electrons: float

    @property
    def pedestal(self) -> float:
        """How far one part of a background may be off another one under a beam, one standard deviation [count]."""
        return float(np.sqrt(np.square(_shift(_PHASES, self.variance)).mean())) if self.uneven else 0.0

    def shifts(self, light: Array, level: float, spread: Array | float = 0.0) -> Array:
        """Return by how much rounding changes the mean of light on a background of a level, above that of the
        background [count]. `spread`: variance of the light over what is averaged [count^2]."""
        variance = self.variance + np.maximum(light, 0) / self.electrons + spread
        found: Array = _shift(level + light, variance) - _shift(np.array([level]), self.variance)
        return found


def rounding(frame: Frame, behind: Plane, beside: Stripes | None, middle: Array, reach: Array) -> Rounding | None:
    """Return what rounding may do to a beam about a `middle` (column, row) that reaches so far to each side [px]; None
    if it does no harm."""
    deviation = frame.read_noise / frame.electrons_per_count or math.sqrt(max(behind.variance - 1 / 12, 0.0))
    if frame.pixels.dtype.kind == "f" or frame.dark is not None or deviation > _QUIET:
        return None
    column, row = (int(min(max(at, 0), n - 1)) for at, n in zip(middle, behind.shape[::-1], strict=True))
    rows, columns = slice(row, row + 1), slice(column, column + 1)
    level = float(behind.over(rows, columns)[0, 0])
    rise = max(2 * abs(s) * r / n for s, r, n in zip(behind.slopes, reach, behind.shape[::-1], strict=True))
    uneven = beside is not None or rise > _EVEN
    if beside is not None:
        level += float(beside.over(rows, columns)[0, 0])
    off = _PHASES + _shift(_PHASES, deviation**2) - (frame.black_level + level)
    apart = np.abs(off - np.round(off))
    some = _PHASES if uneven else _PHASES[apart <= max(_ALIKE, float(apart.min()))]
    return Rounding(some, uneven, deviation**2, frame.electrons_per_count)


def change(lost: Rounding, total: float, moments: Array) -> Array:
    """Return the covariance (6, 6) that rounding adds to total and moments of a Gaussian beam: the area between two
    lines of equal light goes as the logarithm of the light."""
    root = math.sqrt(max(float(moments[2] * moments[3] - moments[4] ** 2), 1e-9))
    peak = total / (2 * math.pi * root)
    out = np.zeros((6, 6))
    if peak <= _DIMMEST:
        return out
    logs = np.linspace(math.log(_DIMMEST), math.log(peak), _STEPS)
    light, step = np.exp(logs), logs[1] - logs[0]
    for level in lost.levels:
        off = lost.shifts(light, float(level), (light * step) ** 2 / 12) * step / peak
        wider = float(off @ (math.log(peak) - logs - 1))
        vector = np.array([float(off.sum()) * total, 0, 0, *(wider * moments[2:])])
        out += np.outer(vector, vector) / len(lost.levels)
    if lost.uneven and peak > LIT:
        # Half of the lit ellipse has one pedestal, half another one.
        area = 2 * math.log(peak / LIT)
        share = lost.pedestal * math.pi * root * area / total
        across, down = (math.sqrt(area * v) for v in moments[2:4])
        own = share * np.array([4 * across / (3 * math.pi), 4 * down / (3 * math.pi), across * down / (2 * math.pi)])
        out[[1, 2, 5], [1, 2, 5]] += own**2
    return out


def _shift(values: Array, variance: Array | float) -> Array:
    """By how much the mean of rounded values is off: the series of a saw tooth, which noise of a variance blurs."""
    out = np.zeros_like(values)
    for k in (1, 2, 3):
        sign = 1 if k % 2 == 0 else -1
        out += sign * np.exp(-2 * (math.pi * k) ** 2 * variance) * np.sin(2 * math.pi * k * values) / (math.pi * k)
    return out
