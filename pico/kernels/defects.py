"""Single pixels that do not follow the light: stuck, hot or dead. Needs numpy and OpenCV at its top: kernels import it
inside their functions."""

from __future__ import annotations

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
_AROUND = [(down, right) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right]


def defects(pixels: NDArray[Any], dark_variance: float, electrons_per_count: float, black: float) -> Places:
    """Return the single pixels of a picture (h, w) that stand out from all of their neighbors, as no light of 3 px or
    more (D4sigma) does.

    `dark_variance`: of a pixel without light [count^2]; `black` [count].
    """
    values = _plain(pixels)
    middle = cv2.medianBlur(values, 3)
    apart = cv2.absdiff(values, middle)
    least = max(np.sqrt(dark_variance), _scatter(apart), 0.5)
    rows, columns = _candidates(apart, middle, least, electrons_per_count, black)
    if not 0 < len(rows) <= _MOST:
        return rows[:0], columns[:0]
    light = np.maximum(middle[rows, columns].astype(float) - black, 0)
    noise = np.sqrt(least**2 + light / electrons_per_count)
    enough = apart[rows, columns] > _STANDS_OUT * noise
    rows, columns = rows[enough], columns[enough]
    alone = lone(values, (rows, columns), 0.5)
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


def repair(values: NDArray[Any], places: Places) -> None:
    """Put the median of its neighbors in the place of each defective pixel of `values` (h, w)."""
    rows, columns = places
    if len(rows):
        values[rows, columns] = median(_neighbors(values, rows, columns), 0)


def median(values: NDArray[Any], axis: int | None = None) -> Any:
    """Return the median along an axis, or of all numbers. That of numpy loads its masked arrays, which takes longer
    than a picture."""
    flat = values.ravel() if axis is None else values
    along = axis or 0
    half, odd = divmod(flat.shape[along], 2)
    middle = [half] if odd else [half - 1, half]
    return np.partition(flat, middle, axis=along).take(middle, axis=along).mean(axis=along)


def _plain(pixels: NDArray[Any]) -> NDArray[Any]:
    """The picture in a type that OpenCV's median takes."""
    if pixels.dtype in (np.uint8, np.uint16, np.float32):
        return np.ascontiguousarray(pixels)
    return pixels.astype(np.uint8 if pixels.dtype.kind == "b" else np.float32)


def _candidates(
    apart: NDArray[Any], middle: NDArray[Any], least: float, electrons_per_count: float, black: float
) -> Places:
    """Pixels farther from their median than a bound below `_STANDS_OUT` standard deviations: the chord of these, for
    noise grows as the root of light, over the whole picture in one pass."""
    top = max(float(cv2.minMaxLoc(middle)[1]) - black, 1.0)
    low, high = _STANDS_OUT * least, _STANDS_OUT * float(np.sqrt(least**2 + top / electrons_per_count))
    slope = (high - low) / top
    over = cv2.addWeighted(apart, 1.0, middle, -slope, slope * black - low)
    places = cv2.findNonZero(cv2.compare(over, np.zeros(1), cv2.CMP_GT))
    if places is None:
        return np.empty(0, np.intp), np.empty(0, np.intp)
    columns, rows = places.reshape(-1, 2).T.astype(np.intp)
    return rows, columns


def _scatter(apart: NDArray[Any]) -> float:
    """One standard deviation of noise, from how far pixels are off the median of the nine about them."""
    return float(median(apart[::8, ::8])) * 1.6


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
