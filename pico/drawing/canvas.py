"""Drawing in millimetres: smooth lines, dashes, arrows and fills on a picture of the table seen from above."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from pico.drawing.label_places import Box, bounds, overlap
from pico.twin.lettering import Align, Color, extent, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Point = tuple[float, float]
_FINE = 2  # the drawing is made larger by this and shrunk in the end
_BITS = 4  # of a pixel's fraction that cv2 looks at


class Canvas:
    """A picture (height, width) of which a millimetre on the table spans `scale` pixels; (0, 0) mm lies at `origin`
    [pixels], y up. Widths of lines and sizes of letters are in pixels of the finished picture."""

    def __init__(self, width: int, height: int, scale: float, origin: Point, paper: Color) -> None:
        import numpy as np

        self.scale, self._origin = scale, origin
        self._size = (width, height)
        self._image = np.full((height * _FINE, width * _FINE, 3), paper, np.uint8)
        self._texts: list[tuple[str, Point, float, Color, Align, int, Color | None]] = []
        self.taken: list[Box] = []
        """Where no words may go any more [pixels]: on what stands there, and on other words."""
        self.words: list[tuple[str, Box]] = []
        """What is written, and where [pixels]."""
        self.leaders: list[tuple[str, Point, Point]] = []
        """Lines from names to what they belong to [pixels]."""
        self._badges: list[tuple[str, Point, float, Color, Color]] = []

    def pixel(self, point: Point) -> Point:
        """Return where a point on the table [mm] is in the finished picture."""
        return self._origin[0] + point[0] * self.scale, self._origin[1] - point[1] * self.scale

    @property
    def bounds(self) -> Box:
        """The whole picture [pixels]."""
        return 0.0, 0.0, float(self._size[0]), float(self._size[1])

    def occupy(self, points: Sequence[Point]) -> None:
        """Let no words be written over the box around `points` [mm]."""
        self.taken.append(bounds([self.pixel(p) for p in points]))

    def occupy_line(self, start: Point, end: Point) -> None:
        """Let no words be written over a line between two points [mm]."""
        a, b = self.pixel(start), self.pixel(end)
        pieces = 1 if min(abs(a[0] - b[0]), abs(a[1] - b[1])) < 1 else math.ceil(math.dist(a, b) / 12)
        ends = [(a[0] + (b[0] - a[0]) * n / pieces, a[1] + (b[1] - a[1]) * n / pieces) for n in range(pieces + 1)]
        self.taken += [bounds(pair) for pair in pairwise(ends)]

    def free(self, box: Box) -> bool:
        """Return whether nothing is in a box, and it lies in the picture [pixels]."""
        inside = box[0] >= 0 and box[1] >= 0 and box[2] <= self._size[0] and box[3] <= self._size[1]
        return inside and not any(overlap(box, other, 1.0) for other in self.taken)

    @staticmethod
    def room(text: str, size: float, weight: int = 400) -> tuple[float, float, float]:
        """Return the width of `text`, and how far it rises above its base line and falls below [pixels]."""
        _, rise, fall = extent("Ag", size, weight)
        return extent(text, size, weight)[0] + 2.0, float(rise), float(fall)

    def rule(self, start: Point, end: Point, color: Color, width: float) -> None:
        """Draw a line between two pixels of the finished picture."""
        ox, oy = self._origin
        self.line([((u - ox) / self.scale, (oy - v) / self.scale) for u, v in (start, end)], color, width)

    def fill(self, points: Sequence[Point], color: Color, opacity: float = 1.0) -> None:
        """Fill a convex polygon [mm]."""
        import cv2

        if opacity >= 1.0:
            cv2.fillConvexPoly(self._image, self._fixed(points), color, cv2.LINE_AA, _BITS)
            return
        layer = self._image.copy()
        cv2.fillConvexPoly(layer, self._fixed(points), color, cv2.LINE_AA, _BITS)
        cv2.addWeighted(layer, opacity, self._image, 1 - opacity, 0, self._image)

    def line(self, points: Sequence[Point], color: Color, width: float = 1.0, *, closed: bool = False) -> None:
        """Draw a line through `points` [mm]."""
        import cv2

        cv2.polylines(
            self._image, [self._fixed(points)], closed, color, max(1, round(width * _FINE)), cv2.LINE_AA, _BITS
        )

    def dashes(self, points: Sequence[Point], color: Color, width: float, pattern: Sequence[float]) -> None:
        """Draw a dashed line through `points` [mm]; `pattern`: lengths of stroke and gap by turns [pixels]."""
        for stroke in _strokes(points, [length / self.scale for length in pattern]):
            self.line(stroke, color, width)

    def arrow(self, start: Point, end: Point, color: Color, width: float = 1.5, head: float = 9.0) -> None:
        """Draw an arrow from `start` to `end` [mm]; `head` [pixels] is the length of its point."""
        length = math.hypot(end[0] - start[0], end[1] - start[1])
        if length * self.scale < 2:
            return
        ux, uy = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        back = min(head / self.scale, length)
        foot = (end[0] - back * ux, end[1] - back * uy)
        self.line((start, foot), color, width)
        side = 0.38 * back
        self.fill((end, (foot[0] - side * uy, foot[1] + side * ux), (foot[0] + side * uy, foot[1] - side * ux)), color)

    def dots(self, centers: Iterable[Point], radius: float, color: Color) -> None:
        """Draw discs of `radius` [mm]."""
        import cv2

        size = round(radius * self.scale * _FINE * (1 << _BITS))
        for x, y in self._fixed(list(centers)).reshape(-1, 2):
            cv2.circle(self._image, (int(x), int(y)), size, color, -1, cv2.LINE_AA, _BITS)

    def text(
        self,
        text: str,
        at: Point,
        size: float,
        color: Color,
        *,
        align: Align = "left",
        weight: int = 400,
        shift: Point = (0, 0),
        halo: Color | None = None,
    ) -> None:
        """Write `text` with its base line at `at` [mm], moved by `shift` [pixels, v down]; `halo` sets it off."""
        u, v = self.pixel(at)
        self._write(text, (u + shift[0], v + shift[1]), size, color, align, weight, halo)

    def label(
        self, text: str, pixel: Point, size: float, color: Color, *, weight: int = 400, halo: Color | None = None
    ) -> None:
        """Write `text` with the middle of its base line at `pixel`, given in the finished picture."""
        self._write(text, pixel, size, color, "center", weight, halo)

    def _write(
        self, text: str, pixel: Point, size: float, color: Color, align: Align, weight: int, halo: Color | None
    ) -> None:
        self._texts.append((text, pixel, size, color, align, weight, halo))
        width, rise, fall = self.room(text, size, weight)
        left = pixel[0] - {"left": 0.0, "center": 0.5, "right": 1.0}[align] * width
        box = (left, pixel[1] - rise, left + width, pixel[1] + fall)
        self.taken.append(box)
        self.words.append((text, box))

    def badge(self, text: str, pixel: Point, radius: float, color: Color, ink: Color) -> None:
        """Draw a disc with `text` in it at `pixel`, `radius` [pixels], both in the finished picture."""
        self._badges.append((text, pixel, radius, color, ink))
        box = (pixel[0] - radius, pixel[1] - radius, pixel[0] + radius, pixel[1] + radius)
        self.taken.append(box)
        self.words.append((text, box))

    def finished(self) -> NDArray[np.uint8]:
        """Return the picture (height, width, 3)."""
        import cv2
        import numpy as np

        image = np.asarray(cv2.resize(self._image, self._size, interpolation=cv2.INTER_AREA), np.uint8)
        for text, (u, v), size, color, align, weight, halo in self._texts:
            if halo is not None:
                _set_off(image, text, (u, v), size, align, weight, halo)
            write(image, text, (u, v), size, color, align=align, weight=weight)
        for text, pixel, radius, color, ink in self._badges:
            _disc(image, pixel, radius + 1.5, ink)
            _disc(image, pixel, radius, color)
            size = (1.35 if len(text) < 3 else 1.0) * radius
            _, rise, _ = extent("0", size, 600)
            write(image, text, (pixel[0], pixel[1] + rise / 2), size, ink, align="center", weight=600)
        return image

    def _fixed(self, points: Sequence[Point]) -> NDArray[np.int32]:
        import numpy as np

        pixels = np.array([self.pixel(p) for p in points], dtype=float).reshape(-1, 2)
        return np.round((pixels * _FINE + (_FINE - 1) / 2) * (1 << _BITS)).astype(np.int32)


def _disc(image: NDArray[np.uint8], at: Point, radius: float, color: Color) -> None:
    import cv2

    one = 1 << _BITS
    cv2.circle(image, (round(at[0] * one), round(at[1] * one)), round(radius * one), color, -1, cv2.LINE_AA, _BITS)


def _set_off(
    image: NDArray[np.uint8], text: str, at: Point, size: float, align: Align, weight: int, halo: Color
) -> None:
    """Lighten the ground behind a text."""
    import numpy as np

    width, rise, fall = extent(text, size, weight)
    left = at[0] - {"left": 0.0, "center": 0.5, "right": 1.0}[align] * width
    rows = slice(max(0, round(at[1]) - rise - 1), max(0, round(at[1]) + max(fall, 0) + 2))
    part = image[rows, max(0, round(left) - 2) : max(0, round(left) + width + 2)]
    part[:] = np.round(part * 0.2 + np.array(halo) * 0.8).astype(np.uint8)


def _strokes(points: Sequence[Point], pattern: Sequence[float]) -> Iterable[list[Point]]:
    """Cut a line into the strokes of a dash pattern (lengths as `points`)."""
    index, left = 0, pattern[0]
    stroke: list[Point] = [points[0]]
    for (x0, y0), (x1, y1) in pairwise(points):
        length, done = math.hypot(x1 - x0, y1 - y0), 0.0
        while length - done > left:
            done += left
            point = (x0 + (x1 - x0) * done / length, y0 + (y1 - y0) * done / length)
            if index % 2 == 0:
                yield [*stroke, point]
            index, stroke = index + 1, [point]
            left = pattern[index % len(pattern)]
        left -= length - done
        if index % 2 == 0:
            stroke.append((x1, y1))
    if index % 2 == 0 and len(stroke) > 1:
        yield stroke
