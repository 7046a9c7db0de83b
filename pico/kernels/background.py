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
_TILE = 4
"""How many blocks wide and high the tiles are from which a curvature is found."""
_CURVED = 30.0
"""Chi-square of the three curvatures from which noise does not explain them: one flat background in a million."""
_ALL = slice(None)


@dataclass(frozen=True, eq=False)
class Plane:
    """A background of a frame of `shape` (h, w): `level` [count], `slopes` across and down [count over the frame's
    whole width, height], all three from the middle of the frame, with their `covariance` (3, 3); `variance` of one
    pixel about it [count^2], the misfit of the plane included."""

    shape: tuple[int, int]
    level: float
    slopes: tuple[float, float]
    covariance: NDArray[np.float64]
    variance: float

    @property
    def coefficients(self) -> NDArray[np.float64]:
        """Level, slope across, slope down."""
        return np.array([self.level, *self.slopes])

    def over(self, rows: slice = _ALL, columns: slice = _ALL) -> NDArray[np.float32]:
        """Return the plane at each pixel of the frame (h, w), or of a part of it."""
        return self._at(shares(self.shape[0])[rows], shares(self.shape[1])[columns])

    def means(self, by: int, rows: slice = _ALL, columns: slice = _ALL) -> NDArray[np.float32]:
        """Return the means of the plane over blocks of `by` x `by` pixels, of all or of a part of them."""
        return self._at(shares(self.shape[0], by)[rows], shares(self.shape[1], by)[columns])

    def _at(self, down: NDArray[np.float64], across: NDArray[np.float64]) -> NDArray[np.float32]:
        right, below = (self.slopes[0] * across).astype(np.float32), (self.slopes[1] * down).astype(np.float32)
        plane: NDArray[np.float32] = np.float32(self.level) + right + below[:, None]
        return plane


def shares(size: int, by: int = 1) -> NDArray[np.float64]:
    """Return where the blocks of `by` pixels of a side of a frame are, as shares of the side from its middle. What is
    left over of the side belongs to no block, but to the side."""
    return (np.arange(size // by) + 0.5) * by / size - 0.5


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


def plane(coarse: NDArray[np.float32], mask: Mask, by: int, shape: tuple[int, int], least: float) -> Plane:
    """Return the plane through the blocks of `mask`, in the means of `by` x `by` pixels of a frame of `shape`. `least`:
    the variance of a pixel that the camera's noise makes by itself [count^2]."""
    places = np.flatnonzero(mask)
    rows, columns = np.divmod(places, coarse.shape[1])
    basis = np.stack([np.ones(len(places)), shares(shape[1], by)[columns], shares(shape[0], by)[rows]])
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
    return Plane(shape, float(found[0]), (float(found[1]), float(found[2])), normal * variance / by**2, variance)


def with_misfit(behind: Plane, coarse: NDArray[np.float32], mask: Mask, by: int) -> Plane:
    """Return the plane with a variance that holds for areas, too.

    The means of tiles outside of the beam scatter by the noise of their pixels, and by more if the background is not
    flat: the variance is that of a pixel which would make the same scatter.
    """
    left, good = _left(behind, coarse, mask, by)
    variance, size = behind.variance, 2
    while min(coarse.shape) >= 2 * size:
        tiles, whole = binned(left, size), binned(good, size) > 0.999
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


def bend(behind: Plane, coarse: NDArray[np.float32], mask: Mask, by: int) -> NDArray[np.float64] | None:
    """Return by how much a curved background differs from the plane, fitted to what lies outside of the beam, too: the
    coefficients (3, 3) of powers of the shares of height and width from the middle; None if noise explains them."""
    left, good = _left(behind, coarse, mask, by)
    places = np.flatnonzero(binned(good, _TILE) > 0.999)
    if len(places) < _TILES:
        return None
    rows, columns = np.divmod(places, coarse.shape[1] // _TILE)
    y, x = shares(behind.shape[0], by * _TILE)[rows], shares(behind.shape[1], by * _TILE)[columns]
    basis = np.stack([np.ones(len(places)), x, y, x * x, x * y, y * y])
    values = binned(left, _TILE).ravel()[places].astype(np.float64)
    normal = np.linalg.pinv(basis @ basis.T)
    found = normal @ (basis @ values)
    variance = float(np.square(values - found @ basis).sum()) / (len(places) - len(found)) + 1e-12
    curved = found[3:]
    if curved @ np.linalg.pinv(normal[3:, 3:] * variance) @ curved < _CURVED:
        return None
    level, across, down, xx, xy, yy = found.tolist()
    return np.array([[level, across, xx], [down, xy, 0.0], [yy, 0.0, 0.0]])


def _left(
    behind: Plane, coarse: NDArray[np.float32], mask: Mask, by: int
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """What blocks of the mask are off the plane, and which of them are near it: 1, else 0 and 0."""
    left = coarse - behind.means(by)
    good = (mask & (np.abs(left) < _OUTLYING * np.sqrt(behind.variance) / by)).astype(np.float32)
    return left * good, good
