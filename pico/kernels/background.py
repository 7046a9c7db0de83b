"""The light that is not the beam's: a tilted plane, fitted to where the beam is not, and how well it fits. Needs numpy
and OpenCV at its top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
_CORNER = 0.05
"""The share of each side that a corner takes: ISO 11146-3 has 2 to 5 %."""
_LEAST = 0.05
"""The share of a picture that must lie outside of the beam for the plane to be fitted there, not to the corners."""
_OUTLYING = 4.0
"""Pixels so many standard deviations off the plane belong to something else: ISO 11146-3 has 2 to 4."""
_COARSE = 96
_TILES = 24
"""Tiles outside of the beam from which their scatter tells how uneven a background is."""
_UNEVEN = 4.0
"""Standard deviations by which the scatter of tiles must exceed what noise makes."""


_ALL = slice(None)


@dataclass(frozen=True, eq=False)
class Plane:
    """A background: `level` [count], `slopes` across and down [count over the frame's whole width, height], all three
    from the middle of the frame, with their `covariance` (3, 3); `variance` of one pixel about it [count^2], the
    misfit of the plane included."""

    level: float
    slopes: tuple[float, float]
    covariance: NDArray[np.float64]
    variance: float

    @property
    def coefficients(self) -> NDArray[np.float64]:
        """Level, slope across, slope down."""
        return np.array([self.level, *self.slopes])

    def over(self, shape: tuple[int, int], rows: slice = _ALL, columns: slice = _ALL) -> NDArray[np.float32]:
        """Return the plane at each pixel of a picture (h, w) of the whole frame, or of a part of it."""
        across, down = (((np.arange(n) + 0.5) / n - 0.5).astype(np.float32) for n in shape[::-1])
        right, below = np.float32(self.slopes[0]) * across[columns], np.float32(self.slopes[1]) * down[rows]
        return np.float32(self.level) + right + below[:, None]


def binning(shape: tuple[int, int]) -> int:
    """Return the edge of the blocks [px] whose means are fine enough to find a beam."""
    return max(1, min(8, min(shape) // _COARSE))


def binned(signal: NDArray[np.float32], by: int) -> NDArray[np.float32]:
    """Return the means of blocks of `by` x `by` pixels; what is left over at the right and below is dropped."""
    h, w = (n // by for n in signal.shape)
    means = cv2.resize(signal[: h * by, : w * by], (w, h), interpolation=cv2.INTER_AREA)
    return means.astype(np.float32, copy=False)


def corners(shape: tuple[int, int]) -> Mask:
    """Return where the four corners of a picture are."""
    h, w = (max(2, round(_CORNER * n)) for n in shape)
    mask = np.zeros(shape, bool)
    for rows in (slice(0, h), slice(-h, None)):
        mask[rows, :w] = mask[rows, -w:] = True
    return mask


def outside(shape: tuple[int, int], box: tuple[int, int, int, int]) -> Mask:
    """Return what lies outside of a box (top, bottom, left, right); the corners where that is too little."""
    top, bottom, left, right = box
    mask = np.ones(shape, bool)
    mask[max(top - 1, 0) : bottom + 1, max(left - 1, 0) : right + 1] = False
    return mask if mask.mean() >= _LEAST else corners(shape)


def plane(coarse: NDArray[np.float32], mask: Mask, by: int, least: float) -> Plane:
    """Return the plane through the blocks of `mask`, in a picture of means of `by` x `by` pixels. `least`: the variance
    of a pixel that the camera's noise makes by itself [count^2]."""
    h, w = coarse.shape
    places = np.flatnonzero(mask)
    x, y = (np.broadcast_to(n, (h, w)).ravel()[places] for n in _places(h, w))
    basis = np.stack([np.ones(len(places)), x, y])
    values = coarse.ravel()[places].astype(np.float64)
    weights = np.ones(len(values))
    for _ in range(3):
        weighed = basis * weights
        normal = np.linalg.inv(weighed @ basis.T)
        found = normal @ (weighed @ values)
        left = values - found @ basis
        kept, squares = weights @ left, weights @ left**2
        count = weights.sum()
        spread = math.sqrt(max(squares / count - (kept / count) ** 2, 0)) + 1e-9
        weights = (np.abs(left) < _OUTLYING * spread).astype(np.float64)
    variance = max(spread**2 * by**2, least)
    return Plane(float(found[0]), (float(found[1]), float(found[2])), normal * variance / by**2, variance)


def _places(h: int, w: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where the columns (1, w) and the rows (h, 1) of a picture are, as shares of its width and height from the
    middle."""
    return ((np.arange(w) + 0.5) / w - 0.5)[None], ((np.arange(h) + 0.5) / h - 0.5)[:, None]


def with_misfit(behind: Plane, coarse: NDArray[np.float32], mask: Mask, by: int) -> Plane:
    """Return the plane with a variance that holds for areas, too.

    The means of tiles outside of the beam scatter by the noise of their pixels, and by more if the background is not
    flat: the variance is that of a pixel which would make the same scatter.
    """
    left = coarse - behind.over((coarse.shape[0], coarse.shape[1]))
    good = (mask & (np.abs(left) < _OUTLYING * np.sqrt(behind.variance) / by)).astype(np.float32)
    variance, size = behind.variance, 2
    while min(coarse.shape) >= 2 * size:
        tiles, whole = binned(left * good, size), binned(good, size) > 0.999
        values = tiles[whole].astype(np.float64)
        if len(values) < _TILES:
            break
        for _ in range(2):
            values = values[np.abs(values - values.mean()) <= _OUTLYING * max(float(values.std()), 1e-6)]
        own = float(values.var()) * (by * size) ** 2
        if own > behind.variance * (1 + _UNEVEN * np.sqrt(2 / len(values))):
            variance = max(variance, own)
        size *= 2
    return replace(behind, variance=variance, covariance=behind.covariance * variance / behind.variance)
