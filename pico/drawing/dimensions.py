"""Lengths on the drawing from above: lines with their measure, and the legs along x and y."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.drawing.canvas import Canvas, Point
from pico.drawing.names import write_name
from pico.twin.lettering import Color

_INK: Color = (120, 20, 120)
_SURFACE: Color = (0, 110, 90)


@dataclass(frozen=True, slots=True)
class Dimension:
    """A length to draw from `start` to `end` [mm], with its measure; `surfaces`: between two faces."""

    start: Point
    end: Point
    text: str
    surfaces: bool = False


def legend(dimensions: Sequence[Dimension]) -> str:
    """Return what the lines are, with their lengths."""
    words = [f"{'green: nearest faces' if d.surfaces else 'violet: points'}, {d.text}" for d in dimensions]
    return " · ".join(words)


def draw_dimensions(canvas: Canvas, dimensions: Sequence[Dimension], size: float) -> None:
    """Draw each length; that between points with its measure, on the side away from dx and dy."""
    for dimension in sorted(dimensions, key=lambda d: d.surfaces):
        (x0, y0), (x1, y1) = dimension.start, dimension.end
        color = _SURFACE if dimension.surfaces else _INK
        sloping = min(abs(x1 - x0), abs(y1 - y0)) * canvas.scale > 12
        if not dimension.surfaces and sloping:
            _legs(canvas, dimension.start, dimension.end, size)
        canvas.line((dimension.start, dimension.end), color, 4.0 if dimension.surfaces else 2.0)
        for tip, back in ((dimension.end, dimension.start), (dimension.start, dimension.end)):
            _tick(canvas, tip, back, color)
        if not dimension.surfaces:
            _beside(canvas, dimension.text, ((x0 + x1) / 2, (y0 + y1) / 2), size, weight=600)


def _legs(canvas: Canvas, start: Point, end: Point, size: float) -> None:
    """The way along x and then along y, with dx and dy."""
    corner = (end[0], start[1])
    for a, b in ((start, corner), (corner, end)):
        canvas.dashes((a, b), _INK, 1.0, (2, 4))
    dx, dy = end[0] - start[0], end[1] - start[1]
    _beside(canvas, f"dx {dx:+.5g}", ((start[0] + corner[0]) / 2, start[1]), 0.8 * size)
    _beside(canvas, f"dy {dy:+.5g}", (corner[0], (start[1] + end[1]) / 2), 0.8 * size)


def _beside(canvas: Canvas, words: str, at: Point, size: float, weight: int = 400) -> None:
    """Write a measure at the nearest free place to a point [mm]."""
    u, v = canvas.pixel(at)
    write_name(canvas, words, (u - 4, v - 4, u + 4, v + 4), size, _INK, weight=weight)


def _tick(canvas: Canvas, tip: Point, back: Point, color: Color) -> None:
    """A short bar across the end of a line."""
    length = math.dist(tip, back)
    if length < 1e-6:
        canvas.dots([tip], 4 / canvas.scale, color)
        return
    half = 6 / canvas.scale
    nx, ny = -(tip[1] - back[1]) / length * half, (tip[0] - back[0]) / length * half
    canvas.line(((tip[0] - nx, tip[1] - ny), (tip[0] + nx, tip[1] + ny)), color, 2.0)
