"""Where the beam is on a picture, and its first and second moments as ISO 11146 has them. Needs numpy and OpenCV at its
top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import Plane, binned, binning, corners, outside, plane
from pico.kernels.frame import Frame

Array = NDArray[np.float64]
Box = tuple[int, int, int, int]
"""Top, bottom, left, right [px], the second and the fourth exclusive."""
_REGION = 3.0
"""Widths that the region of integration measures: ISO 11146-1, 7.2."""
_ROUNDS = 20
_AT_LAST = 4
"""Rounds over means of blocks, then over the pixels themselves, at most."""
_SIGNIFICANT = 3.0
"""Standard deviations of a block that the brightest place must exceed to be light."""
_START = 0.2
"""The share of the brightest place above which a beam is followed at first."""
_INSIDE = 0.75
"""Widths (D4sigma) that the middle of a beam must keep from the edges of the frame. A Gaussian beam nearer to one has
lost more than 0.1 % of its light."""
_ALIKE = 0.01
"""Standard deviations of the beam by which a region may still move when it counts as settled."""
_CUT = 1 / (1 - math.log(1 / _START) * _START / (1 - _START))
"""By how much the variances of a Gaussian are larger than those of its part above `_START` of its peak."""
DARK = "there is no light above the background"
_ADRIFT = "the region of integration does not settle: the background is not flat, or the beam is not alone"


@dataclass(frozen=True, eq=False)
class Spot:
    """A beam on a frame. `total` [count]; `moments`: column and row of its middle [px], variances along the columns,
    along the rows, and across [px^2]; `covariance` (6, 6) of total and moments; the `box` integrated over; the
    background."""

    total: float
    moments: Array
    covariance: Array
    box: Box
    background: Plane


@dataclass(frozen=True, eq=False)
class Start:
    """Where the beam is roughly: `moments` as those of `Spot`; the means of blocks of `by` pixels, and their plane."""

    moments: Array
    coarse: NDArray[np.float32]
    by: int
    background: Plane


def found(frame: Frame) -> Start | str:
    """Return where the brightest spot is; why there is none."""
    if why := frame.refusal:
        return why
    by = binning(frame.pixels.shape)
    coarse = binned(frame.signal, by)
    behind = plane(coarse, corners(coarse.shape), by, frame.dark_variance)
    above = coarse - behind.over(coarse.shape)
    smooth = cv2.blur(above, (3, 3))
    top = float(smooth.max())
    noise = math.sqrt(behind.variance) / by
    if top < _SIGNIFICANT * noise or top <= 0:
        return DARK
    own = np.where(smooth > max(_START * top, 2 * noise), above, np.float32(0))
    total, moments = _moments(sums(own.astype(np.float64), (0, 0)))
    if total <= 0:
        return DARK
    moments[2:] = np.maximum(moments[2:] * _CUT, [0.1, 0.1, -np.inf])
    return Start(_finer(moments, by), coarse, by, behind)


def spot(frame: Frame, iterated: bool = False) -> Spot | str:
    """Return the beam's moments over a region of three widths, above a plane fitted to what lies outside; negative
    residuals stay. Why there are none, else.

    The region is about the beam's middle. Its widths are those that the beam's bright part tells; `iterated`: those
    that come out of the moments in it, as ISO 11146 has it, which a halo lets grow until nothing is known.
    """
    start = found(frame)
    if isinstance(start, str):
        return start
    held = None if iterated else start.moments[2:]
    settled = _settled(start, held, frame.dark_variance)
    if isinstance(settled, str):
        return settled
    moments, behind = settled
    signal = frame.signal
    shape = signal.shape
    box = _box(moments, held, shape)
    for _ in range(_AT_LAST):
        total, moments = _above(signal, box, behind)
        if not _sane(total, moments, shape):
            return _ADRIFT
        box, before = _box(moments, held, shape), box
        if _moved(box, before) <= 1 + _ALIKE * math.sqrt(moments[2:4].max()):
            break
    else:
        return _ADRIFT
    if why := leaving(moments if held is None else np.concatenate([moments[:2], held]), shape):
        return why
    return Spot(total, moments, _covariance(frame, signal, before, behind, total, moments), before, behind)


def leaving(moments: Array, shape: tuple[int, ...]) -> str:
    """Return that the beam leaves the frame, where it does."""
    for middle, variance, size, ends in (
        (moments[0], moments[2], shape[1], ("left", "right")),
        (moments[1], moments[3], shape[0], ("top", "bottom")),
    ):
        reach = _INSIDE * 4 * math.sqrt(variance)
        for gap, end in ((middle + 0.5, ends[0]), (size - 0.5 - middle, ends[1])):
            if gap < reach:
                text = f"the spot leaves the frame at the {end}: of what is seen of it the middle is {gap:.4g} px"
                return f"{text} from there, and it reaches {reach:.4g} px"
    return ""


def _settled(start: Start, held: Array | None, least: float) -> tuple[Array, Plane] | str:
    """Find the region over the means of blocks; the moments there in pixels of the frame, and the plane."""
    coarse, by, behind = start.coarse, start.by, start.background
    moments = _coarser(start.moments, by)
    widths = None if held is None else moments[2:]
    box = _box(moments, widths, coarse.shape)
    for _ in range(_ROUNDS):
        behind = plane(coarse, outside(coarse.shape, box), by, least)
        total, moments = _above(coarse, box, behind)
        if not _sane(total, moments, coarse.shape):
            return _ADRIFT
        box, before = _box(moments, widths, coarse.shape), box
        if _moved(box, before) <= 1:
            return _finer(moments, by), behind
    return _ADRIFT


def _moved(a: Box, b: Box) -> int:
    return max(abs(one - other) for one, other in zip(a, b, strict=True))


def _finer(moments: Array, by: int) -> Array:
    return np.concatenate([moments[:2] * by + (by - 1) / 2, moments[2:] * by**2])


def _coarser(moments: Array, by: int) -> Array:
    return np.concatenate([(moments[:2] - (by - 1) / 2) / by, moments[2:] / by**2])


def _sane(total: float, moments: Array, shape: tuple[int, ...]) -> bool:
    """Whether it may be a beam: light, a middle inside the frame, widths above zero and not beyond the frame's."""
    if not (total > 0 and np.isfinite(moments).all()):
        return False
    column, row, across, down, both = moments
    inside = -0.5 <= column <= shape[1] - 0.5 and -0.5 <= row <= shape[0] - 0.5
    return bool(
        inside and 0 < across < shape[1] ** 2 / 12 and 0 < down < shape[0] ** 2 / 12 and both**2 < across * down
    )


def _box(moments: Array, held: Array | None, shape: tuple[int, ...]) -> Box:
    """The region of integration: `_REGION` widths (4 standard deviations) in all, 5 px at least, inside the picture."""
    variances = moments[2:4] if held is None else held[:2]
    across, down = (max(2.5, _REGION * 2 * math.sqrt(v)) for v in variances)
    column, row = moments[:2]
    top, left = max(0, math.floor(row - down)), max(0, math.floor(column - across))
    return top, min(shape[0], math.ceil(row + down) + 1), left, min(shape[1], math.ceil(column + across) + 1)


def _powers(size: int, first: float, highest: int = 4) -> Array:
    """The powers 0 to `highest` of the places along one side of a box, (size, highest + 1)."""
    places: Array = np.arange(size, dtype=np.float64) - first
    return np.vander(places, highest + 1, increasing=True)


def sums(values: Array, origin: tuple[float, float], highest: int = 2) -> Array:
    """Return the sums of value x row^j x column^k, (j, k), about an origin (row, column) of the array (h, w)."""
    h, w = values.shape
    found: Array = _powers(h, origin[0], highest).T @ (values @ _powers(w, origin[1], highest))
    return found


def _flat(box: Box, origin: tuple[float, float], highest: int) -> Array:
    """The sums of a picture that is 1 all over the box."""
    h, w = box[1] - box[0], box[3] - box[2]
    return np.outer(_powers(h, origin[0], highest).sum(0), _powers(w, origin[1], highest).sum(0))


def _basis(box: Box, shape: tuple[int, ...], origin: tuple[float, float]) -> Array:
    """The three parts of a plane as polynomials (3, row^j, column^k) about an origin of a box."""
    basis = np.zeros((3, 2, 2))
    basis[0, 0, 0] = 1.0
    basis[1, 0, :] = (box[2] + origin[1] + 0.5) / shape[1] - 0.5, 1 / shape[1]
    basis[2, :, 0] = (box[0] + origin[0] + 0.5) / shape[0] - 0.5, 1 / shape[0]
    return basis


def _beam_sums(
    signal: NDArray[np.float32], box: Box, behind: Plane, origin: tuple[float, float], highest: int
) -> Array:
    """The sums of a beam above its background."""
    part = signal[box[0] : box[1], box[2] : box[3]].astype(np.float64)
    found = sums(part, origin, highest)
    flat = _flat(box, origin, highest + 1)
    for coefficient, poly in zip(behind.coefficients, _basis(box, signal.shape, origin), strict=True):
        found -= coefficient * _times(poly, flat, highest + 1)
    return found


def _times(poly: Array, sums: Array, size: int) -> Array:
    """The sums of what is weighted with a polynomial besides, up to `size` powers each."""
    out = np.zeros((size, size))
    for (j, k), coefficient in np.ndenumerate(poly):
        if coefficient:
            out += coefficient * sums[j : j + size, k : k + size]
    return out


def _moments(sums: Array) -> tuple[float, Array]:
    """Total and moments from sums about the origin of the array."""
    total = float(sums[0, 0])
    if total <= 0:
        return total, np.full(5, np.nan)
    row, column = sums[1, 0] / total, sums[0, 1] / total
    across, down, both = sums[0, 2] / total, sums[2, 0] / total, sums[1, 1] / total
    return total, np.array([column, row, across - column**2, down - row**2, both - row * column])


def _above(signal: NDArray[np.float32], box: Box, behind: Plane) -> tuple[float, Array]:
    """Total and moments of a beam in a box, in pixels of the picture."""
    origin = ((box[1] - box[0] - 1) / 2, (box[3] - box[2] - 1) / 2)
    total, moments = _moments(_beam_sums(signal, box, behind, origin, 2))
    moments[:2] += box[2] + origin[1], box[0] + origin[0]
    return total, moments


def _weights(total: float, moments: Array) -> Array:
    """How total and moments follow each pixel, as polynomials (6, row^j, column^k) about the middle of the beam."""
    weights = np.zeros((6, 3, 3))
    weights[0, 0, 0] = 1.0
    weights[1, 0, 1] = weights[2, 1, 0] = weights[3, 0, 2] = weights[4, 2, 0] = weights[5, 1, 1] = 1 / total
    weights[3:, 0, 0] = -moments[2:] / total
    return weights


def _covariance(
    frame: Frame, signal: NDArray[np.float32], box: Box, behind: Plane, total: float, moments: Array
) -> Array:
    """The covariance of total and moments: shot noise of the beam, noise of each pixel, and that of the plane."""
    origin = (moments[1] - box[0], moments[0] - box[2])
    beam, flat = _beam_sums(signal, box, behind, origin, 4), _flat(box, origin, 4)
    noise = beam / frame.electrons_per_count + behind.variance * flat
    weights = _weights(total, moments)
    covariance = np.array([[_sum(_product(a, b), noise) for b in weights] for a in weights])
    basis = _basis(box, signal.shape, origin)
    follow = np.array([[_sum(_product(a, b), flat) for b in basis] for a in weights])
    out: Array = covariance + follow @ behind.covariance @ follow.T
    return out


def _product(a: Array, b: Array) -> Array:
    """The product of two polynomials."""
    out = np.zeros((a.shape[0] + b.shape[0] - 1, a.shape[1] + b.shape[1] - 1))
    for (j, k), coefficient in np.ndenumerate(b):
        if coefficient:
            out[j : j + a.shape[0], k : k + a.shape[1]] += coefficient * a
    return out


def _sum(poly: Array, sums: Array) -> float:
    return float((poly * sums[: poly.shape[0], : poly.shape[1]]).sum())
