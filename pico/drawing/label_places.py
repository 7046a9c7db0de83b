"""Where names go on a drawing so that none lies on another one or on what is drawn: the nearest free place."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from pico.drawing.svg import Box

_GAP = 2.0  # mm between a name and anything else
_DIRECTIONS = (90, -90, 0, 180, 45, 135, -45, -135, 22, 158, -22, -158, 68, 112, -68, -112)  # deg, 90 is below
_RINGS = 60


def overlap(a: Box, b: Box, gap: float = 0.0) -> bool:
    """Return whether two boxes come nearer than `gap` in x and in y."""
    return a[0] < b[2] + gap and b[0] < a[2] + gap and a[1] < b[3] + gap and b[1] < a[3] + gap


def free_place(around: Box, width: float, height: float, taken: Sequence[Box], within: Box) -> tuple[Box, bool]:
    """Return the box of `width` x `height` nearest to `around` that meets none of `taken` and lies `within`, and
    whether it lies right beside it; right below where there is no room at all."""
    first = None
    for ring, box in _candidates(around, width, height):
        first = first or box
        inside = box[0] >= within[0] and box[1] >= within[1] and box[2] <= within[2] and box[3] <= within[3]
        if inside and not any(overlap(box, other, _GAP) for other in taken):
            return box, ring == 0
    assert first is not None
    return first, True


def _candidates(around: Box, width: float, height: float) -> Iterator[tuple[int, Box]]:
    x, y = (around[0] + around[2]) / 2, (around[1] + around[3]) / 2
    half_x, half_y = (around[2] - around[0] + width) / 2 + _GAP, (around[3] - around[1] + height) / 2 + _GAP
    for ring in range(_RINGS):
        grow = ring * height * 0.6
        for angle in _DIRECTIONS if ring else _DIRECTIONS[:4]:
            c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
            reach = min(
                (half_x + grow) / abs(c) if abs(c) > 1e-9 else 1e9, (half_y + grow) / abs(s) if abs(s) > 1e-9 else 1e9
            )
            cx, cy = x + reach * c, y + reach * s
            yield ring, (cx - width / 2, cy - height / 2, cx + width / 2, cy + height / 2)
