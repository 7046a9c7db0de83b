"""Names beside footprints in a drawing: below, above or inside, smaller where it is crowded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pico.twin.canvas import Canvas, Point
from pico.twin.lettering import Color, extent

Box = tuple[float, float, float, float]
Outlines = Mapping[str, Sequence[Point]]

_WEIGHT = 600
_SIZES = (0.92, 0.78, 0.66)
_WHITE: Color = (255, 255, 255)


def write_names(canvas: Canvas, outlines: Outlines, size: float, color: Color) -> None:
    """Write each name at its outline [mm], where it covers the least of other names and outlines."""
    shapes = {name: _box([canvas.pixel(p) for p in points]) for name, points in outlines.items()}
    taken: list[Box] = []
    for name in sorted(shapes, key=lambda n: (shapes[n][1], n)):
        others = [box for other, box in shapes.items() if other != name]
        options = _options(name, shapes[name], size)
        costs = [_covered(box, taken) * 4 + _covered(box, others) + rank for rank, (box, _) in enumerate(options)]
        box, letters = options[costs.index(min(costs))]
        taken.append(box)
        inside = shapes[name][1] < (box[1] + box[3]) / 2 < shapes[name][3]
        canvas.label(
            name, ((box[0] + box[2]) / 2, box[3] - 2), letters, color, weight=_WEIGHT, halo=None if inside else _WHITE
        )


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
