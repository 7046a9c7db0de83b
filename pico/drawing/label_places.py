"""Where names go on a drawing so that none lies on another one or on what is drawn: the nearest free place.

Boxes are (left, top, right, bottom), y down, in the unit of the drawing: millimetres or pixels.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

Box = tuple[float, float, float, float]
Point = tuple[float, float]

_GAP = 2.0  # between a name and anything else
BELOW, ABOVE, RIGHT, LEFT = 90, -90, 0, 180
BESIDE = (BELOW, ABOVE, RIGHT, LEFT)
"""Directions in which a name is looked for right beside its thing [deg, y down], the best first."""
_AROUND = (90, -90, 0, 180, 45, 135, -45, -135, 22, 158, -22, -158, 68, 112, -68, -112)
_RINGS = 60


def overlap(a: Box, b: Box, gap: float = 0.0) -> bool:
    """Return whether two boxes come nearer than `gap` in x and in y."""
    return a[0] < b[2] + gap and b[0] < a[2] + gap and a[1] < b[3] + gap and b[1] < a[3] + gap


def bounds(points: Sequence[Point]) -> Box:
    """Return the box around points."""
    us, vs = zip(*points, strict=True)
    return min(us), min(vs), max(us), max(vs)


def free_place(
    around: Box, width: float, height: float, taken: Sequence[Box], within: Box, beside: Sequence[int] = BESIDE
) -> tuple[Box, bool] | None:
    """Return the box of `width` x `height` nearest to `around` that meets none of `taken` and lies `within`, and
    whether it lies right beside it; None where there is no room."""
    import numpy as np

    left, top, right, bottom = np.array(taken, float).reshape(-1, 4).T
    for ring, box in _candidates(around, width, height, beside):
        if box[0] < within[0] or box[1] < within[1] or box[2] > within[2] or box[3] > within[3]:
            continue
        aside = (box[0] < right + _GAP) & (left < box[2] + _GAP)
        if not (aside & (box[1] < bottom + _GAP) & (top < box[3] + _GAP)).any():
            return box, ring == 0
    return None


def nearest(box: Box, point: Point) -> Point:
    """Return the point of a box that is nearest to another one."""
    return min(max(point[0], box[0]), box[2]), min(max(point[1], box[1]), box[3])


def middle(box: Box) -> Point:
    """Return the middle of a box."""
    return (box[0] + box[2]) / 2, (box[1] + box[3]) / 2


def _candidates(around: Box, width: float, height: float, beside: Sequence[int]) -> Iterator[tuple[int, Box]]:
    x, y = middle(around)
    half_x, half_y = (around[2] - around[0] + width) / 2 + _GAP, (around[3] - around[1] + height) / 2 + _GAP
    for ring in range(_RINGS):
        grow = ring * height * 0.6
        for angle in _AROUND if ring else beside:
            c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            reach = min(
                (half_x + grow) / abs(c) if abs(c) > 1e-9 else 1e9, (half_y + grow) / abs(s) if abs(s) > 1e-9 else 1e9
            )
            cx, cy = x + reach * c, y + reach * s
            yield ring, (cx - width / 2, cy - height / 2, cx + width / 2, cy + height / 2)
