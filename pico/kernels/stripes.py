"""Backgrounds that are the same all along a column or a row: smear of an interline CCD, columns that differ, the step
between two taps. Needs numpy and OpenCV at its top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import Plane
from pico.kernels.defects import median

Array = NDArray[np.float64]
_REACHES = (1.5, 1.25, 1.0)
"""Widths (D4sigma) to each side of a beam's middle beyond which its light is none, the first that leaves enough beside
it: there a Gaussian has 2e-8, 4e-6 and 3e-4 of its peak."""
_ENOUGH, _LEAST = 0.1, 0.04
"""Shares of a side of the frame that must lie beside the beam: to keep a distance, and at all."""
_FEWEST = 8
"""Rows beside the beam, or columns, from which stripes can be told."""
_GROUPS = 12
_SIGNIFICANT = 6.0
"""Standard deviations from which the offset of a column, or of several in a row, is none of noise."""


@dataclass(frozen=True, eq=False)
class Stripes:
    """Offsets of each column (w,) and of each row (h,) [count], and the variance of one of either [count^2]; zero where
    there are none."""

    columns: NDArray[np.float32]
    rows: NDArray[np.float32]
    variances: tuple[float, float]

    def over(self) -> NDArray[np.float32]:
        """Return the stripes at each pixel (h, w)."""
        return self.rows[:, None] + self.columns


def stripes(signal: NDArray[np.float32], behind: Plane, moments: Array) -> Stripes | None:
    """Return the offsets of columns and rows above a plane, from what lies beside a beam of such moments (column, row,
    their variances); None if there are none that noise does not explain."""
    h, w = signal.shape
    flat = np.zeros(w)
    columns = _offsets(signal, behind, moments, 0, flat)
    rows = _offsets(signal, behind, moments, 1, flat if columns is None else columns[0])
    if columns is None and rows is None:
        return None
    found = [(np.zeros(n), 0.0) if one is None else one for one, n in ((columns, w), (rows, h))]
    return Stripes(found[0][0].astype(np.float32), found[1][0].astype(np.float32), (found[0][1], found[1][1]))


def _offsets(
    signal: NDArray[np.float32], behind: Plane, moments: Array, axis: int, other: Array
) -> tuple[Array, float] | None:
    """Offsets along one axis and the variance of each: the median of groups of rows (axis 0) or columns (axis 1), so
    that a second spot beside the beam does no harm. `other`: offsets of the columns, taken off first."""
    groups = _groups(signal.shape[axis], float(moments[1 - axis]), 4 * math.sqrt(float(moments[3 - axis])))
    if len(groups) < 3:
        return None
    size, along = signal.shape[1 - axis], signal.shape[axis]
    places = (np.arange(size) + 0.5) / size - 0.5
    means = np.empty((len(groups), size))
    for i, (first, last) in enumerate(groups):
        part = signal[first:last] if axis == 0 else signal[:, first:last]
        means[i] = cv2.reduce(part, axis, cv2.REDUCE_AVG).ravel()
        middle = (first + last) / 2 / along - 0.5
        means[i] -= behind.level + behind.slopes[axis] * places + behind.slopes[1 - axis] * middle
        means[i] -= other[first:last].mean() if axis == 1 else 0.0
    found = median(means, 0)
    found -= np.polyval(np.polyfit(places, found, 1), places)  # the plane has level and slope
    # Of neighbors: the deviations from a median of few groups are too small.
    apart = np.diff(means, axis=0)
    spread = float(apart[np.abs(apart) <= 4 * apart.std()].std()) / math.sqrt(2)
    variance = math.pi / 2 * max(spread, 1e-6) ** 2 / len(groups)
    return (found, variance) if _significant(found, math.sqrt(variance)) else None


def _groups(size: int, middle: float, width: float) -> list[tuple[int, int]]:
    """First and last (exclusive) of groups of rows or columns beside a beam."""
    for reach in _REACHES:
        low = min(max(0, math.floor(middle - reach * width)), size)
        high = min(max(0, math.ceil(middle + reach * width) + 1), size)
        if low + size - high >= _ENOUGH * size:
            break
    left = low + size - high
    if left < max(_FEWEST, _LEAST * size):
        return []
    each = max(2, left // _GROUPS)
    return [
        (at, min(at + each, end))
        for start, end in ((0, low), (high, size))
        for at in range(start, end - each // 2, each)
        if min(at + each, end) > at
    ]


def _significant(offsets: Array, sigma: float) -> bool:
    """Whether offsets are more than noise: one, the mean of several in a row, or their scatter."""
    n = len(offsets)
    if float(np.square(offsets).mean()) / sigma**2 > 1 + _SIGNIFICANT * math.sqrt(2 / n):
        return True
    for wide in (1, 4, 16, 64):
        if n >= 2 * wide:
            means = offsets[: n // wide * wide].reshape(-1, wide).mean(axis=1)
            if float(np.abs(means).max()) * math.sqrt(wide) > _SIGNIFICANT * sigma:
                return True
    return False
