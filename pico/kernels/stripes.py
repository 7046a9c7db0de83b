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
from pico.kernels.frame import Frame

Array = NDArray[np.float64]
_REACHES = (1.5, 1.25, 1.0)
"""Widths (D4sigma) to each side of a beam's middle beyond which its light is none, the first that leaves enough beside
it: there a Gaussian has 2e-8, 4e-6 and 3e-4 of its peak."""
_ENOUGH, _LEAST = 0.1, 0.04
"""Shares of a side of the frame that must lie beside the beam: to keep a distance, and at all."""
_FEWEST = 8
"""Rows beside the beam, or columns, from which stripes can be told."""
_GROUPS = 12
_ALL = slice(None)
_SIGNIFICANT = 6.0
"""Standard deviations from which the offset of a column, or of several in a row, is none of noise."""


@dataclass(frozen=True, eq=False)
class Stripes:
    """Offsets of each column (w,) and of each row (h,) [count], and the variance of one of either [count^2]; zero where
    there are none."""

    columns: NDArray[np.float32]
    rows: NDArray[np.float32]
    variances: tuple[float, float]

    def over(self, rows: slice = _ALL, columns: slice = _ALL) -> NDArray[np.float32]:
        """Return the stripes at each pixel of the frame (h, w), or of a part of it."""
        return self.rows[rows, None] + self.columns[columns]

    def means(self, by: int) -> NDArray[np.float32]:
        """Return the means of the stripes over blocks of `by` x `by` pixels."""
        rows, columns = (_means(one, by) for one in (self.rows, self.columns))
        means: NDArray[np.float32] = rows[:, None] + columns
        return means

    def light(self, by: int = 1) -> tuple[Array, Array]:
        """Return what may be light in the stripes of columns and of rows, the means of `by` each [count]: what is above
        their median. Smear has the noise of light."""
        columns, rows = (
            np.maximum(_means(one, by).astype(np.float64) - median(one), 0) for one in (self.columns, self.rows)
        )
        return columns, rows


def _means(one: NDArray[np.float32], by: int) -> NDArray[np.float32]:
    means: NDArray[np.float32] = one[: len(one) // by * by].reshape(-1, by).mean(axis=1)
    return means


def without(frame: Frame, beside: Stripes | None, rows: slice, columns: slice) -> NDArray[np.float32]:
    """Return a part of a frame's signal without stripes [count]."""
    part = frame.part(rows, columns)
    if beside is not None:
        part -= beside.over(rows, columns)
    return part


def stripes(frame: Frame, behind: Plane, moments: Array) -> Stripes | None:
    """Return the offsets of columns and rows above a plane, from what lies beside a beam of such moments (column, row,
    their variances); None if there are none that noise does not explain."""
    h, w = frame.pixels.shape
    flat = np.zeros(w)
    columns = _offsets(frame, behind, moments, 0, flat)
    rows = _offsets(frame, behind, moments, 1, flat if columns is None else columns[0])
    if columns is None and rows is None:
        return None
    found = [(np.zeros(n), 0.0) if one is None else one for one, n in ((columns, w), (rows, h))]
    return Stripes(found[0][0].astype(np.float32), found[1][0].astype(np.float32), (found[0][1], found[1][1]))


def _offsets(frame: Frame, behind: Plane, moments: Array, axis: int, other: Array) -> tuple[Array, float] | None:
    """Offsets along one axis and the variance of each: the median of groups of rows (axis 0) or columns (axis 1), so
    that a second spot beside the beam does no harm. `other`: offsets of the columns, taken off first."""
    shape = frame.pixels.shape
    groups = _groups(shape[axis], float(moments[1 - axis]), 4 * math.sqrt(float(moments[3 - axis])))
    if len(groups) < 3:
        return None
    size, along = shape[1 - axis], shape[axis]
    places = (np.arange(size) + 0.5) / size - 0.5
    means = np.empty((len(groups), size))
    for i, (first, last) in enumerate(groups):
        means[i] = _profile(frame, axis, slice(first, last))
        middle = (first + last) / 2 / along - 0.5
        means[i] -= behind.level + behind.slopes[axis] * places + behind.slopes[1 - axis] * middle
        means[i] -= other[first:last].mean() if axis == 1 else 0.0
    # Of neighbors: the deviations from a median of few groups are too small.
    apart = np.diff(means, axis=0)
    spread = float(apart[np.abs(apart) <= 4 * apart.std()].std()) / math.sqrt(2)
    variance = max(spread, 1e-6) ** 2 / len(groups)
    if not _significant(_level(means.mean(axis=0), places), math.sqrt(variance)):
        return None  # spares the medians
    found, variance = _level(median(means, 0), places), math.pi / 2 * variance
    return (found, variance) if _significant(found, math.sqrt(variance)) else None


def _profile(frame: Frame, axis: int, some: slice) -> Array:
    """The mean of some rows (axis 0) or columns (axis 1) of a frame's signal [count]."""
    here = (some, _ALL) if axis == 0 else (_ALL, some)
    count = some.stop - some.start
    sums = cv2.reduce(frame.plain[here], axis, cv2.REDUCE_SUM, dtype=cv2.CV_32F).ravel()
    means: Array = sums.astype(np.float64) / count
    means -= frame.black_level if frame.dark is None else frame.dark[here].mean(axis=axis)
    places, values = frame.repairs
    if not len(values):
        return means
    inside = (places[axis] >= some.start) & (places[axis] < some.stop)
    rows, columns = places[0][inside], places[1][inside]
    np.add.at(means, places[1 - axis][inside], (values[inside] - frame.above(rows, columns)) / count)
    return means


def _level(offsets: Array, places: Array) -> Array:
    """Offsets without their mean and slope, which the plane has. `places`: evenly spaced about zero."""
    slope = places @ offsets / (places @ places)
    level: Array = offsets - offsets.mean() - slope * places
    return level


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
