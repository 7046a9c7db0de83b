"""Names on the drawing from above: each at the nearest free place to what it belongs to.

Nothing is written over a component or over other words; what finds no room is left out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from pico.drawing.canvas import Canvas, Point
from pico.drawing.label_places import Box, along, bounds, free_place, leader, middle
from pico.twin.lettering import Color

_LEAST = 11.0
"""Letters are not made smaller than this for the sake of room [pixels]."""
_LINE: Color = (120, 128, 138)
_WHITE: Color = (255, 255, 255)


@dataclass(frozen=True, slots=True)
class Named:
    """A name, the outline that it belongs to [mm], and the color of its letters."""

    name: str
    outline: Sequence[Point]
    color: Color


def write_names(canvas: Canvas, things: Sequence[Named], size: float) -> None:
    """Write each name beside its outline, at most `size` [pixels] high: smaller where parts stand close."""
    shapes = [bounds([canvas.pixel(p) for p in thing.outline]) for thing in things]
    size = max(min(size, _LEAST), _fitting(canvas, things, shapes, size))
    for index in sorted(range(len(things)), key=lambda i: (shapes[i][1], shapes[i][0])):
        write_name(canvas, things[index].name, shapes[index], size, things[index].color, weight=600, line=True)


def _fitting(canvas: Canvas, things: Sequence[Named], shapes: Sequence[Box], size: float) -> float:
    """The size [pixels] at which a name is no wider than the way to the next outline beside its own."""
    found = size
    for thing, shape in zip(things, shapes, strict=True):
        x, y = middle(shape)
        beside = [middle(other)[0] - x for other in shapes if shape[1] < middle(other)[1] < shape[3]]
        room = min((abs(way) for way in beside if abs(way) > 1), default=math.inf) - 4
        if sum(0 < abs(middle(other)[1] - y) < 1.8 * (shape[3] - shape[1]) for other in shapes) > 1:
            found = min(found, size * room / canvas.room(thing.name, size, 600)[0])
    return found


def write_name(
    canvas: Canvas, words: str, around: Box, size: float, color: Color, *, weight: int = 400, line: bool = False
) -> None:
    """Write words at the nearest free place to a box [pixels]; `line`: with one to it where they are not beside it."""
    width, rise, fall = canvas.room(words, size, weight)
    others = [box for box in canvas.taken if box != around] if line else None
    found = free_place(around, width, rise + fall, canvas.taken, canvas.bounds, crossed=others)
    if found is None:
        return
    box, beside = found
    if line and not beside:
        start, end = leader(around, box)
        canvas.rule(start, end, _LINE, 1.0)
        canvas.leaders.append((words, start, end))
        canvas.taken += along(start, end)
    canvas.label(words, ((box[0] + box[2]) / 2, box[3] - fall), size, color, weight=weight, halo=_WHITE)


def write_first(canvas: Canvas, words: str, spots: Sequence[Point], size: float, color: Color) -> None:
    """Write words with the middle of their base line at the first of some spots [pixels] where there is room."""
    width, rise, fall = canvas.room(words, size, 400)
    for u, v in spots:
        box = (u - width / 2, v - rise, u + width / 2, v + fall)
        if canvas.free(box):
            canvas.label(words, (u, v), size, color)
            return
