"""Where names go on a drawing so that none lies on another one or on what is drawn: the nearest free place.

Boxes are (left, top, right, bottom), y down, in the unit of the drawing: millimetres or pixels.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

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
    around: Box, width: float, height: float, taken: Sequence[Box], within: Box, beside: Sequence[int] = BESIDE,
    crossed: Sequence[Box] | None = None,
) -> tuple[Box, bool] | None:  # fmt: skip
    """Return the box of `width` x `height` nearest to `around` that meets none of `taken` and lies `within`, and
    whether it lies right beside it; None where there is no room. `crossed`: what the line from it to `around` does not
    cross, unless there is no other room."""
    import numpy as np

    left, top, right, bottom = np.array(taken, float).reshape(-1, 4).T
    last = None
    for ring, box in _candidates(around, width, height, beside):
        if box[0] < within[0] or box[1] < within[1] or box[2] > within[2] or box[3] > within[3]:
            continue
        aside = (box[0] < right + _GAP) & (left < box[2] + _GAP)
        if (aside & (box[1] < bottom + _GAP) & (top < box[3] + _GAP)).any():
            continue
        if ring == 0 or not crossed or not meets(*leader(around, box), crossed):
            return box, ring == 0
        last = last or (box, False)
    return last


def leader(around: Box, box: Box) -> tuple[Point, Point]:
    """Return the ends of the line from a thing to its name."""
    start = nearest(around, middle(box))
    return start, nearest(box, start)


def meets(start: Point, end: Point, boxes: Sequence[Box]) -> bool:
    """Return whether a line between two points meets any of the boxes."""
    import numpy as np

    walls = np.array(boxes, float).reshape(-1, 2, 2)
    way = np.subtract(end, start)
    way = np.where(np.abs(way) < 1e-9, 1e-9, way)
    enter = np.minimum(*((walls - start) / way).swapaxes(0, 1))
    leave = np.maximum(*((walls - start) / way).swapaxes(0, 1))
    return bool((np.maximum(enter.max(axis=1), 0.0) < np.minimum(leave.min(axis=1), 1.0)).any())


def along(start: Point, end: Point) -> list[Box]:
    """Return boxes that cover a line."""
    pieces = max(1, math.ceil(math.dist(start, end) / 8))
    ends = [tuple(a + (b - a) * n / pieces for a, b in zip(start, end, strict=True)) for n in range(pieces + 1)]
    return [bounds((a, b)) for a, b in pairwise(ends)]  # type: ignore[arg-type]


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
