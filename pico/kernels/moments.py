"""The spot of a beam in a frame: its background, where it is, and its second moments after ISO 11146-3.

Pixels throughout, row 0 at the top, (0, 0) the middle of the first pixel. Negative residuals are kept, or widths would
be too large. The region of integration is three times as wide as the beam along each axis, and is found by iterating.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pico.kernels.frame import Frame, Result, spoilt

Array = NDArray[np.floating]
BIN = 8
"""By how much a frame is reduced where the spot is looked for first."""
_CORNER = 0.11
"""How much of each side of a frame a corner is, where its background is looked for first."""
_ROUNDS = 30
_STEADY = 1e-4
"""Where neither place nor width change by more than this share of the width, they are found."""
_FAINT = 6.0
"""A spot whose power is not this many of its standard deviations is none."""


@dataclass(frozen=True)
class Plane:
    """A background at + across x + down y [count], x and y in pixels from the middle of the frame; `sigma`: of those."""

    at: float = 0.0
    across: float = 0.0
    down: float = 0.0
    sigma: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Spot:
    """A spot. `total` [count]; `x`, `y` of its centroid; `xx`, `xy`, `yy`: second moments [pixel^2]; `region`: rows and
    columns that were summed over; `noise`: variance of a pixel without light [count^2]; `plane`: what was taken off."""

    total: float
    x: float
    y: float
    xx: float
    xy: float
    yy: float
    region: tuple[slice, slice]
    noise: float
    plane: Plane


def find(frame: Frame) -> Spot | Result:
    """Return the spot of a frame; why there is none, or none to be believed, as a result that is unknown."""
    spoils = spoilt(frame)
    if spoils:
        return spoils
    plane, noise = background(frame)
    box = _first(frame, plane, noise)
    if box is None:
        return Result(unknown="no light: nothing stands out of the noise")
    spot = _moments(frame, box, plane, noise)
    for n in range(_ROUNDS):
        if n == 2 and not frame.flat:  # the spot is known well enough to take all that is beside it for the background
            plane = _beside(frame, spot, plane, noise)
        if spot.total <= 0 or min(spot.xx, spot.yy) <= 0:
            return Result(unknown="no light: what stands out of the noise is no spot")
        after = _moments(frame, _box(frame, spot), plane, noise)
        width = 4 * np.sqrt(max(after.xx, after.yy, 1e-12))
        moved = max(abs(after.x - spot.x), abs(after.y - spot.y))
        moved = max(moved, *(abs(_width(a) - _width(b)) for a, b in ((after.xx, spot.xx), (after.yy, spot.yy))))
        spot = after
        if n > 2 and moved < _STEADY * width:
            break
    return _believed(frame, spot)


def _width(moment: float) -> float:
    return float(4 * np.sqrt(max(moment, 0.0)))


def _believed(frame: Frame, spot: Spot) -> Spot | Result:
    h, w = frame.pixels.shape
    if min(spot.xx, spot.yy) <= 0:
        return Result(unknown="no light: what stands out of the noise is no spot")
    rows, columns = spot.region
    area = (rows.stop - rows.start) * (columns.stop - columns.start)
    if spot.total < _FAINT * np.sqrt(spot.noise * area + spot.total / frame.electrons_per_count):
        return Result(unknown="no light: nothing stands out of the noise")
    wide, high = _width(spot.xx), _width(spot.yy)
    if spot.x - wide / 2 < 0 or spot.x + wide / 2 > w - 1 or spot.y - high / 2 < 0 or spot.y + high / 2 > h - 1:
        return Result(unknown=f"the spot, {wide:.0f} x {high:.0f} pixels wide, leaves the frame of {w} x {h}")
    return spot


def background(frame: Frame) -> tuple[Plane, float]:
    """Return the background by the corners of a frame, and the variance of a pixel there [count^2]."""
    pixels = frame.pixels
    h, w = pixels.shape
    if frame.flat:
        return Plane(), _quiet(pixels)
    down, across = max(2, round(_CORNER * h)), max(2, round(_CORNER * w))
    y, x = np.arange(h) - (h - 1) / 2, np.arange(w) - (w - 1) / 2
    found: list[tuple[float, float, float]] = []
    values = []
    for rows in (slice(0, down), slice(h - down, h)):
        for columns in (slice(0, across), slice(w - across, w)):
            part = pixels[rows, columns].astype(np.float32)
            middle = float(np.median(part))
            scatter = 1.4826 * float(np.median(np.abs(part - middle))) + 0.5
            kept = part[np.abs(part - middle) <= 4 * scatter]  # not what is hot
            found.append((float(kept.mean()), float(x[columns].mean()), float(y[rows].mean())))
            values.append(kept.var())
    noise = float(np.median(values))
    design = np.array([[1.0, a, b] for _, a, b in found])
    at, tilt, slope = np.linalg.lstsq(design, np.array([v for v, _, _ in found]), rcond=None)[0]
    each = noise / max(1, down * across)
    sigma = np.sqrt(np.diagonal(np.linalg.inv(design.T @ design)) * each)
    return Plane(float(at), float(tilt), float(slope), (float(sigma[0]), float(sigma[1]), float(sigma[2]))), noise


def _quiet(pixels: NDArray[Any]) -> float:
    h, w = pixels.shape
    part = np.concatenate([pixels[: h // 10].ravel(), pixels[-h // 10 :].ravel()]).astype(np.float32)
    return float((1.4826 * np.median(np.abs(part - np.median(part)))) ** 2)


def flattened(frame: Frame, rows: slice, columns: slice, plane: Plane) -> NDArray[np.float32]:
    """Return a part of a frame (h, w) without its background."""
    h, w = frame.pixels.shape
    part = frame.pixels[rows, columns].astype(np.float32)
    y = (np.arange(rows.start, rows.stop) - (h - 1) / 2).astype(np.float32)
    x = (np.arange(columns.start, columns.stop) - (w - 1) / 2).astype(np.float32)
    part -= (np.float32(plane.at) + np.float32(plane.down) * y)[:, None]
    part -= np.float32(plane.across) * x
    return part


def _first(frame: Frame, plane: Plane, noise: float) -> tuple[slice, slice] | None:
    """Return where the spot is about, by the frame reduced to means of squares; None where nothing stands out."""
    h, w = frame.pixels.shape
    side = BIN if min(h, w) >= 16 * BIN else 1
    rows, columns = h // side * side, w // side * side
    # rows first: sums of whole rows are quick
    small = np.add.reduceat(frame.pixels[:rows, :columns], np.arange(0, rows, side), axis=0, dtype=np.float32)
    small = small.reshape(rows // side, columns // side, side).sum(axis=2) / np.float32(side * side)
    y = (np.arange(rows // side) + 0.5) * side - h / 2
    x = (np.arange(columns // side) + 0.5) * side - w / 2
    small = small - (plane.at + plane.down * y[:, None] + plane.across * x).astype(np.float32)
    quiet = np.sqrt(noise) / side
    peak = float(np.partition(small.ravel(), -3)[-3]) if small.size > 8 else float(small.max())
    if peak < 5 * quiet:
        return None
    bright = np.where(small > max(0.2 * peak, 4 * quiet), small, 0.0)
    total = float(bright.sum())
    cx, cy = (float((bright.sum(axis=n) * axis).sum()) / total for n, axis in ((0, x), (1, y)))
    # above a fifth of its peak the second moment of a Gaussian is 0.6 of the whole
    sx = np.sqrt(float((bright.sum(axis=0) * (x - cx) ** 2).sum()) / total / 0.6 + side**2 / 12)
    sy = np.sqrt(float((bright.sum(axis=1) * (y - cy) ** 2).sum()) / total / 0.6 + side**2 / 12)
    return _around(frame, cx + (w - 1) / 2, cy + (h - 1) / 2, 6 * sx, 6 * sy)


def _around(frame: Frame, x: float, y: float, across: float, down: float) -> tuple[slice, slice]:
    """Return the region within so many pixels of a place, as far as the frame goes; never empty."""
    h, w = frame.pixels.shape

    def span(middle: float, reach: float, size: int) -> slice:
        reach = max(reach, 2.0)
        first = min(max(round(middle - reach), 0), size - 1)
        return slice(first, max(first + 1, min(round(middle + reach) + 1, size)))

    return span(y, down, h), span(x, across, w)


def _box(frame: Frame, spot: Spot) -> tuple[slice, slice]:
    return _around(frame, spot.x, spot.y, 1.5 * _width(spot.xx), 1.5 * _width(spot.yy))


def _moments(frame: Frame, region: tuple[slice, slice], plane: Plane, noise: float) -> Spot:
    rows, columns = region
    part = flattened(frame, rows, columns, plane)
    y, x = np.arange(rows.start, rows.stop, dtype=float), np.arange(columns.start, columns.stop, dtype=float)
    down, across = part.sum(axis=1, dtype=float), part.sum(axis=0, dtype=float)
    total = float(down.sum())
    if total <= 0:
        return Spot(total, float(x.mean()), float(y.mean()), 0.0, 0.0, 0.0, region, noise, plane)
    cx, cy = float(across @ x) / total, float(down @ y) / total
    dx, dy = x - cx, y - cy
    each = (part @ dx.astype(np.float32)).astype(float)
    return Spot(
        total, cx, cy, float(across @ dx**2) / total, float(dy @ each) / total, float(down @ dy**2) / total, region,
        noise, plane,
    )  # fmt: skip


def _beside(frame: Frame, spot: Spot, plane: Plane, noise: float) -> Plane:
    """Return the background by all that is not in the region of a spot, or by the corners where that is little.

    The normal equations take sums over the whole frame less those over the region; what is hot is left in, for it is as
    good as nothing among millions.
    """
    h, w = frame.pixels.shape
    rows, columns = _around(frame, spot.x, spot.y, 2 * _width(spot.xx), 2 * _width(spot.yy))
    inside = (rows.stop - rows.start) * (columns.stop - columns.start)
    if h * w - inside < 0.05 * h * w:
        return plane
    y, x = np.arange(h) - (h - 1) / 2, np.arange(w) - (w - 1) / 2
    ones = np.ones(max(h, w), dtype=np.float32)

    def sums(part: NDArray[np.float32], y: Array, x: Array) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        down = (part @ ones[: len(x)]).astype(float)
        first = np.array([down.sum(), float((ones[: len(y)] @ part).astype(float) @ x), float(down @ y)])
        n, sx, sy = len(x) * len(y), x.sum() * len(y), y.sum() * len(x)
        cross = x.sum() * y.sum()
        return first, np.array(
            [[n, sx, sy], [sx, (x**2).sum() * len(y), cross], [sy, cross, (y**2).sum() * len(x)]]
        )  # fmt: skip

    whole = [sums(part, y[n : n + 256], x) for n in range(0, h, 256)
             for part in [frame.pixels[n : n + 256].astype(np.float32)]]  # fmt: skip
    less = sums(frame.pixels[rows, columns].astype(np.float32), y[rows], x[columns])
    right = sum((s[0] for s in whole), np.zeros(3)) - less[0]
    matrix = sum((s[1] for s in whole), np.zeros((3, 3))) - less[1]
    found = np.linalg.solve(matrix, right)
    sigma = np.sqrt(np.diagonal(np.linalg.inv(matrix)) * noise)
    return replace(
        plane, at=float(found[0]), across=float(found[1]), down=float(found[2]),
        sigma=(float(sigma[0]), float(sigma[1]), float(sigma[2])),
    )  # fmt: skip


def variances(frame: Frame, spot: Spot) -> tuple[float, float, float, float, float]:
    """Return the variances of x, y [pixel^2], xx, yy [pixel^4] and total [count^2] of a spot.

    By the error propagation of its sums: a pixel has the variance of its electrons and of reading them, and the
    background is the same for all.
    """
    rows, columns = spot.region
    ny, nx = rows.stop - rows.start, columns.stop - columns.start
    n, one = nx * ny, 1 / frame.electrons_per_count
    sum_x2, sum_y2 = n * nx**2 / 12, n * ny**2 / 12
    b0, bx, by = spot.plane.sigma
    x = spot.xx * one / spot.total + (sum_x2 * spot.noise + (sum_x2 * bx) ** 2) / spot.total**2
    y = spot.yy * one / spot.total + (sum_y2 * spot.noise + (sum_y2 * by) ** 2) / spot.total**2

    def second(m: float, side: int, sum2: float) -> float:
        shot = 2 * m**2 * one / spot.total
        quiet = spot.noise * n * (side**4 / 80 - m * side**2 / 6 + m**2) / spot.total**2
        return shot + quiet + (b0 * (sum2 - n * m) / spot.total) ** 2

    return x, y, second(spot.xx, nx, sum_x2), second(spot.yy, ny, sum_y2), (
        spot.total * one + n * spot.noise + (n * b0) ** 2
    )  # fmt: skip


def placed(frame: Frame, x: float, y: float) -> tuple[float, float]:
    """Return a place in pixels as x to the right and y up from the middle of the sensor [um]."""
    h, w = frame.pixels.shape
    return (x - (w - 1) / 2) * frame.pixel_size, ((h - 1) / 2 - y) * frame.pixel_size
