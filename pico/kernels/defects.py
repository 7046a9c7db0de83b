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
"""The share of a defect's excess by which the means of opposite neighbors differ at most. At the middle of a beam of
3 px (D4sigma) it is 0.46."""
_MOST = 20_000
"""Candidates beyond which a picture is grainy by itself, and no pixel of it is called defective."""
_STRIP = 1 << 17
"""Pixels at a time: they stay in the cache of the processor."""
_BANDS = 12
"""Places down a picture at which its noise is looked at."""
_AROUND = [(down, right) for down in (-1, 0, 1) for right in (-1, 0, 1) if down or right]


def defects(pixels: NDArray[Any], dark_variance: float, electrons_per_count: float, black: float) -> Places:
    """Return the single pixels of a picture (h, w) that stand out from all of their neighbors, as no light of 3 px or
    more (D4sigma) does.

    `pixels`: of 8 or 16 bits without a sign, or float32; `dark_variance`: of a pixel without light [count^2]; `black`
    [count].
    """
    scatter, darkest = _dark(pixels)
    least, black = max(math.sqrt(dark_variance), scatter, 0.5), min(black, darkest)
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
    and far more than light lets these differ; one of the eight may be defective, too.

    Means of opposite neighbors are compared, which are the same on any slope.
    """
    rows, columns = places
    if not 0 < len(rows) <= _MOST:
        return np.zeros(len(rows), bool)
    out, paired, worst = _standing(pixels, rows, columns, least)
    beside: dict[tuple[int, int], list[int]] = {}  # which pixels stand out but for this one
    for i in np.flatnonzero(paired & ~out).tolist():
        down, right = _AROUND[worst[i]]
        beside.setdefault((int(rows[i]) + down, int(columns[i]) + right), []).append(i)
    if beside:
        index = {place: i for i, place in enumerate(zip(rows.tolist(), columns.tolist(), strict=True))}
        for place, some in beside.items():
            if _cluster(pixels, place, [7 - int(worst[i]) for i in some], least):
                out[[*some, *([index[place]] if place in index else [])]] = True
    return out


def _cluster(pixels: NDArray[Any], place: tuple[int, int], left_out: list[int], least: float) -> bool:
    """Whether a pixel stands out from its neighbors but for one or two, which are left out. That at the middle of a
    small beam stands out from the diagonal ones, but not from all."""
    rows, columns = (np.array([at]) for at in place)
    rest = [i for i in range(4) if i not in left_out and 7 - i not in left_out]
    if len(left_out) > 2 or len(rest) < 2 or rest == [0, 2]:
        return False
    if not (0 <= place[0] < pixels.shape[0] and 0 <= place[1] < pixels.shape[1]):
        return False
    around = _neighbors(pixels, rows, columns)
    own = pixels[rows, columns].astype(np.float64)
    return bool(_stands_out(own, (around + around[::-1])[rest] / 2, least)[0])


def _standing(
    pixels: NDArray[Any], rows: NDArray[np.intp], columns: NDArray[np.intp], least: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.intp]]:
    """Whether each pixel stands out from all of its neighbors; whether from all but the one that differs most; and
    which that is of `_AROUND`."""
    own, around = pixels[rows, columns].astype(np.float64), _neighbors(pixels, rows, columns)
    pairs = (around + around[::-1])[:4] / 2
    worst = np.abs(around - median(around, 0)).argmax(axis=0)
    out, paired = _stands_out(own, pairs, least), np.zeros(len(rows), bool)
    for at, offset in enumerate(_AROUND):
        some = np.flatnonzero((worst == at) & ~out)
        rest = [i for i in range(4) if i not in (at, 7 - at)]
        slopes = (around - around[::-1])[rest][:, some] / 2
        slope = np.linalg.pinv(np.array([_AROUND[i] for i in rest], float)) @ slopes
        level = pairs[rest][:, some]
        other = around[7 - at, some] - (level.mean(axis=0) - np.array(offset, float) @ slope)
        paired[some] = _stands_out(own[some], level, least, np.abs(other))
    return out, paired, worst


def _stands_out(own: Any, pairs: NDArray[np.float64], least: float, more: Any = 0.0) -> NDArray[np.bool_]:
    """Whether pixels differ by `least` and more from each of the means of pairs (m, n) of their neighbors, and these by
    a small share of that from one another; `more`: what else they differ by."""
    low, high = pairs.min(axis=0), pairs.max(axis=0)
    excess = np.maximum(own - high, low - own)
    out: NDArray[np.bool_] = (excess >= least) & (high - low + more < _SHARE * excess)
    return out


def replacements(values: NDArray[Any], places: Places, dark: NDArray[Any] | None = None) -> NDArray[np.float64]:
    """Return what defective pixels of `values` (h, w) would read above those of `dark`, by their neighbors: smooth
    light has the same second differences along rows, columns and diagonals."""
    rows, columns = places
    if not len(rows):
        return np.empty(0)
    around = _neighbors(values, rows, columns)
    if dark is not None:
        around -= _neighbors(dark, rows, columns)
    h, w = values.shape
    bad = np.zeros((h + 2, w + 2), bool)
    bad[[0, -1]] = bad[:, [0, -1]] = True  # a pixel at an edge has no neighbor there
    bad[rows + 1, columns + 1] = True
    good = np.array([~bad[rows + 1 + down, columns + 1 + right] for down, right in _AROUND]).reshape(8, len(rows))
    pairs, whole = (around + around[::-1])[:4] / 2, (good & good[::-1])[:4]
    smooth = np.array([-0.5, 1.0, -0.5, 1.0]) @ pairs
    some = (pairs * whole).sum(axis=0) / np.maximum(whole.sum(axis=0), 1)
    found: NDArray[np.float64] = np.where(whole.any(axis=0), some, median(around, 0))
    return np.where(whole.all(axis=0), smooth, found)


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
    rows_each = max(8, _STRIP // pixels.shape[1])
    for first in range(0, pixels.shape[0], rows_each):
        apart, middle = _apart(pixels, first, first + rows_each)
        if cv2.minMaxLoc(apart)[1] <= low:
            continue
        top = max(float(cv2.minMaxLoc(middle)[1]) - black, 1.0)
        slope = (_STANDS_OUT * math.sqrt(least**2 + top / electrons_per_count) - low) / top
        lit = cv2.max(middle, np.array([max(black, 0.0)]))  # darker pixels have no less noise
        over = cv2.addWeighted(apart, 1.0, lit, -slope, slope * black - low, dtype=cv2.CV_32F)
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


def _dark(pixels: NDArray[Any]) -> tuple[float, float]:
    """One standard deviation of noise, from how far pixels are off the median of the nine about them, and the least of
    these medians, over some rows of the picture. What is above it may be light, which has noise."""
    step = max(8, pixels.shape[0] // _BANDS)
    some = [_apart(pixels, first, first + 4) for first in range(0, pixels.shape[0] - 3, step)]
    scatter = float(median(np.concatenate([apart[:, ::4].ravel() for apart, _ in some]))) * 1.6
    return scatter, min(float(middle.min()) for _, middle in some)


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
