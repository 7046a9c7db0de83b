"""A frame with two axes in a picture, and what is drawn in it: points with their standard deviations, lines."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from pico.twin.lettering import extent, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Color = tuple[int, int, int]
PAPER, INK, FAINT, RULE = (252, 252, 253), (34, 40, 49), (126, 134, 146), (222, 226, 232)
COLORS = ((58, 138, 196), (224, 110, 36), (52, 136, 108), (128, 92, 182), (176, 132, 44), (188, 58, 50))
_NOTE = 17
"""Height of a line of notes [pixels]."""


@dataclass(frozen=True)
class Axes:
    """A frame in `image` (height, width, 3): its edges [pixels], and the range of each axis."""

    image: NDArray[np.uint8]
    left: int
    right: int
    top: int
    foot: int
    x: tuple[float, float]
    y: tuple[float, float]

    def column(self, x: float) -> int:
        """Return where a value of x is [pixels]."""
        return round(self.left + (self.right - self.left) * (x - self.x[0]) / (self.x[1] - self.x[0]))

    def row(self, y: float) -> int:
        """Return where a value of y is [pixels]."""
        return round(self.foot - (self.foot - self.top) * (y - self.y[0]) / (self.y[1] - self.y[0]))

    def frame(self, x_label: str, y_label: str, *, numbered: bool = True) -> None:
        """Draw both axes with round numbers; those of x only where they are `numbered`."""
        image = self.image
        image[self.top : self.foot, self.left] = RULE
        image[self.foot, self.left : self.right] = RULE
        for x in ticks(*self.x):
            image[self.foot : self.foot + 5, self.column(x)] = RULE
            if numbered:
                at = (self.column(x), self.foot + 19)
                write(image, f"{x:.6g}", at, 12, FAINT, align="center", weight=500)
        for y in ticks(*self.y):
            image[self.row(y), self.left - 5 : self.right : 3] = RULE
            write(image, f"{y:.6g}", (self.left - 9, self.row(y) + 4), 12, FAINT, align="right", weight=500)
        write(image, x_label, (self.right, self.foot + 44), 13, INK, align="right", weight=500)
        write(image, y_label, (16, self.top - 14), 13, INK, weight=500)

    def points(
        self, x: Sequence[float], y: Sequence[float], sigma: Sequence[float | None], color: Color
    ) -> None:  # fmt: skip
        """Draw points with a bar of one standard deviation where that is known."""
        import cv2

        for a, b, s in zip(x, y, sigma, strict=True):
            if s:
                ends = [(self.column(a), self.row(b + way * s)) for way in (-1, 1)]
                cv2.line(self.image, ends[0], ends[1], color, 1, cv2.LINE_AA)
                for u, v in ends:
                    self.image[min(len(self.image) - 1, max(0, v)), u - 3 : u + 4] = color
            cv2.circle(self.image, (self.column(a), self.row(b)), 4, color, -1, cv2.LINE_AA)

    def line(self, x: Sequence[float], y: Sequence[float], color: Color) -> None:
        """Draw a line through points, from left to right; a single one is a short stroke."""
        import cv2

        ends = [(self.column(a), self.row(b)) for a, b in sorted(zip(x, y, strict=True))]
        if len(ends) == 1:
            (u, v), = ends  # fmt: skip
            ends = [(u - 9, v), (u + 9, v)]
        for a, b in pairwise(ends):
            cv2.line(self.image, a, b, color, 1, cv2.LINE_AA)


def paper(title: str, width: int, height: int, notes: Sequence[str] = ()) -> NDArray[np.uint8]:
    """Return an empty picture (h, width, 3), sRGB, with a title, and notes below its `height`."""
    import numpy as np

    lines = [line for note in notes for line in _wrapped(note, width - 32)]
    image = np.full((height + (len(lines) * _NOTE + 14 if lines else 0), width, 3), PAPER, np.uint8)
    write(image, title, (16, 27), 17, INK, weight=600)
    for n, line in enumerate(lines):
        write(image, line, (16, height + 8 + n * _NOTE), 12, FAINT, weight=500)
    return image


def ticks(low: float, high: float) -> Iterator[float]:
    """Yield round numbers between two, about five."""
    step = 10.0 ** math.floor(math.log10((high - low) / 5))
    step *= next(m for m in (1, 2, 5, 10) if (high - low) / (step * m) <= 6)
    first = math.ceil(low / step)
    yield from (n * step for n in range(first, math.floor(high / step) + 1))


def roomy(low: float, high: float) -> tuple[float, float]:
    """Return a range with some room around it."""
    room = 0.06 * (high - low) or abs(high) * 0.05 or 1.0
    return low - room, high + room


def _wrapped(text: str, width: float) -> Iterator[str]:
    line = ""
    for word in text.split():
        longer = f"{line} {word}".strip()
        if line and extent(longer, 12, 500)[0] > width:
            yield line
            longer = word
        line = longer
    yield line
