"""Names beside footprints in a drawing: below, above or inside, smaller where it is crowded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from pico.drawing.canvas import Canvas, Point
from pico.twin.lettering import Color, extent

Box = tuple[float, float, float, float]

_WEIGHT = 600
_SIZES = (0.92, 0.78, 0.66)
_WHITE: Color = (255, 255, 255)


@dataclass(frozen=True, slots=True)
class Named:
    """A name, the outline that it belongs to [mm], and the color of its letters."""

    name: str
    outline: Sequence[Point]
    color: Color


def write_names(canvas: Canvas, things: Sequence[Named], size: float) -> None:
    """Write each name at its outline, where it covers the least of other names and outlines."""
    shapes = [_box([canvas.pixel(p) for p in thing.outline]) for thing in things]
    taken: list[Box] = []
    for index in sorted(range(len(things)), key=lambda i: (shapes[i][1], things[i].name)):
        others = [box for number, box in enumerate(shapes) if number != index]
        options = _options(things[index].name, shapes[index], size)
        costs = [_covered(box, taken) * 4 + _covered(box, others) + rank for rank, (box, _) in enumerate(options)]
        box, letters = options[costs.index(min(costs))]
        taken.append(box)
        inside = shapes[index][1] < (box[1] + box[3]) / 2 < shapes[index][3]
        foot, halo = ((box[0] + box[2]) / 2, box[3] - 2), None if inside else _WHITE
        canvas.label(things[index].name, foot, letters, things[index].color, weight=_WEIGHT, halo=halo)


def _options(name: str, shape: Box, size: float) -> list[tuple[Box, float]]:
    """Places for a name with the size of its letters, the best first."""
    middle = (shape[0] + shape[2]) / 2
    found = []
    for share in _SIZES:
        letters = max(8.0, share * size)
        half, height = extent(name, letters, _WEIGHT)[0] / 2 + 1, letters + 2
        tops = (shape[3] + 3, shape[1] - height - 2, shape[3] - height - 2)
        found += [((middle - half, top, middle + half, top + height), letters) for top in tops]
    return found


def _box(pixels: Sequence[Point]) -> Box:
    us, vs = zip(*pixels, strict=True)
    return min(us), min(vs), max(us), max(vs)


def _covered(box: Box, others: Sequence[Box]) -> float:
    """The area of `box` that `others` cover [square pixels]."""
    return sum(
        max(0.0, min(box[2], o[2]) - max(box[0], o[0])) * max(0.0, min(box[3], o[3]) - max(box[1], o[1]))
        for o in others
    )
