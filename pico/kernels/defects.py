"""Single pixels that do not follow the light: stuck, hot or dead. Needs numpy and OpenCV at its top: kernels import it
inside their functions."""

from __future__ import annotations

import math
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

Places = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Rows and columns of pixels."""
_STANDS_OUT = 8.0
"""Standard deviations of a pixel's noise by which a defect differs from the pixels around it."""
_SHARE = 0.25
"""The share of a defect's excess that none of its eight neighbors reaches. A beam of 3 px (D4sigma) about the middle of
a pixel gives its neighbors 0.41 of what that one has."""
_MOST = 20_000
"""Candidates beyond which a picture is grainy by itself, and no pixel of it is called defective."""
_STRIP = 32
"""Rows at a time."""
_BANDS = 24
"""Places down a picture at which its noise is looked at."""
_AROUND = [(down, right) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right]


def defects(pixels: NDArray[Any], dark_variance: float, electrons_per_count: float, black: float) -> Places:
    """Return the single pixels of a picture (h, w) that stand out from all of their neighbors, as no light of 3 px or
    more (D4sigma) does.

    `pixels`: of 8 or 16 bits without a sign, or float32; `dark_variance`: of a pixel without light [count^2]; `black`
    [count].
    """
    least = max(math.sqrt(dark_variance), _scatter(pixels), 0.5)
    rows, columns = _candidates(pixels, least, electrons_per_count, black)
    if not 0 < len(rows) <= _MOST:
        return rows[:0], columns[:0]
    own = pixels[rows, columns].astype(float)
    middle = median(np.concatenate([_neighbors(pixels, rows, columns), own[None]]), 0)
    noise = np.sqrt(least**2 + np.maximum(middle - black, 0) / electrons_per_count)
    enough = np.abs(own - middle) > _STANDS_OUT * noise
    rows, columns = rows[enough], columns[enough]
    alone = lone(pixels, (rows, columns), 0.5)
    return rows[alone], columns[alone]


def lone(pixels: NDArray[Any], places: Places, least: float) -> NDArray[np.bool_]:
    """Return whether each of some pixels of a picture (h, w) stands out from its neighbors by `least` [count] or more,
    and far more than these from one another."""
    rows, columns = places
    if not 0 < len(rows) <= _MOST:
        return np.zeros(len(rows), bool)
    around = _neighbors(pixels, rows, columns)
    level = median(around, 0)
    excess = np.abs(pixels[rows, columns].astype(np.float64) - level)
    beside = np.abs(around - level).max(axis=0)
    alone: NDArray[np.bool_] = (excess >= least) & (beside < _SHARE * excess)
    return alone


def replacements(values: NDArray[Any], places: Places, dark: NDArray[Any] | None = None) -> NDArray[np.float64]:
    """Return the median of the eight neighbors of each defective pixel of `values` (h, w), above those of `dark`."""
    around = _neighbors(values, *places)
    if dark is not None:
        around -= _neighbors(dark, *places)
    found: NDArray[np.float64] = median(around, 0)
    return found


def median(values: NDArray[Any], axis: int | None = None) -> Any:
    """Return the median along an axis, or of all numbers. That of numpy loads its masked arrays, which takes longer
    than a picture."""
    flat = values.ravel() if axis is None else values
    along = axis or 0
    half, odd = divmod(flat.shape[along], 2)
    middle = [half] if odd else [half - 1, half]
    return np.partition(flat, middle, axis=along).take(middle, axis=along).mean(axis=along)


def _candidates(pixels: NDArray[Any], least: float, electrons_per_count: float, black: float) -> Places:
    """Pixels farther from the median of the nine about them than a bound below `_STANDS_OUT` standard deviations: the
    chord of these, for noise grows as the root of light. Strip by strip, which stays in the cache of the processor."""
    found, low = [np.empty((0, 2), np.intp)], _STANDS_OUT * least
    for first in range(0, pixels.shape[0], _STRIP):
        apart, middle = _apart(pixels, first, first + _STRIP)
        if cv2.minMaxLoc(apart)[1] <= low:
            continue
        top = max(float(cv2.minMaxLoc(middle)[1]) - black, 1.0)
        slope = (_STANDS_OUT * math.sqrt(least**2 + top / electrons_per_count) - low) / top
        over = cv2.addWeighted(apart, 1.0, middle, -slope, slope * black - low, dtype=cv2.CV_32F)
        places = cv2.findNonZero(cv2.compare(over, np.zeros(1), cv2.CMP_GT))
        if places is not None:
            found.append(places.reshape(-1, 2).astype(np.intp) + np.array([0, first]))
    columns, rows = np.concatenate(found).T
    return rows, columns


def _apart(pixels: NDArray[Any], first: int, last: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """How far the pixels of some rows are from the median of the nine about each, and that median."""
    above = min(first, 1)
    some = pixels[first - above : last + 1]
    rows = slice(above, above + min(last, pixels.shape[0]) - first)
    middle = cv2.medianBlur(some, 3)[rows]
    return cv2.absdiff(some[rows], middle), middle


def _scatter(pixels: NDArray[Any]) -> float:
    """One standard deviation of noise, from how far pixels are off the median of the nine about them."""
    step = max(8, pixels.shape[0] // _BANDS)
    some = [_apart(pixels, first, first + 4)[0][:, ::4].ravel() for first in range(0, pixels.shape[0] - 3, step)]
    return float(median(np.concatenate(some))) * 1.6


def _neighbors(values: NDArray[Any], rows: NDArray[np.intp], columns: NDArray[np.intp]) -> NDArray[np.float64]:
    """The eight pixels about each place (8, n); beyond an edge those on the other side of the pixel count twice."""
    h, w = values.shape
    around = []
    for down, right in _AROUND:
        row, column = rows + down, columns + right
        row = np.where((row < 0) | (row >= h), rows - down, row)
        column = np.where((column < 0) | (column >= w), columns - right, column)
        around.append(values[row, column])
    return np.array(around, dtype=np.float64).reshape(8, len(rows))
