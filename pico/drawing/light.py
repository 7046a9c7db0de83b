"""Beams in a picture from above, as they run through lenses and plates, with their radius along the way below it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from pico.drawing.beams import Place
from pico.drawing.canvas import Point
from pico.drawing.topview import drawn, letters
from pico.model.setup import Setup
from pico.optics.geometry import geometry_of
from pico.twin.lettering import write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.optics.following import Crossing
from pico.optics.light import Light

WIDTH = 960
_BEAM = (224, 36, 36)
_PAPER, _INK, _FAINT, _RULE = (252, 252, 253), (34, 40, 49), (126, 134, 146), (206, 211, 218)
_BITS = 4  # of a coordinate between pixels
_SAMPLES = 24
"""Points of a leg at which the radius is drawn."""


def render_light(
    setup: Setup, poses: Mapping[str, Place], light: Light, *, width: int = WIDTH,
    red: Sequence[Sequence[tuple[float, float]]] = (),
) -> NDArray[np.uint8]:  # fmt: skip
    """Return the picture (height, width, 3), sRGB: the bench from above, and a strip for each source. `red`: branches
    that are not safe."""
    import numpy as np

    lines = [line for number in range(len(light.crossings)) for line in _lines(light, number)]
    canvas = drawn(setup, poses, {}, width=width, height=None, ghosts={}, labels=True, beams=lines, red=red)
    strips = [_strip(light, source, width) for source in dict.fromkeys(c.beam.source for c in light.crossings)]
    return np.vstack([canvas.finished(), *strips])


def _lines(light: Light, number: int) -> Iterator[tuple[Point, Point]]:
    """Yield the way of a crossing; before it, what leads across a roof mirror to where it begins."""
    crossing = light.crossings[number]
    away = crossing.beam.length - _begun(light, crossing)
    start = crossing.beam.at - away * crossing.beam.along
    last = None if crossing.before is None else light.crossings[crossing.before]
    if last is not None and geometry_of(light.parts[last.component].optic.element).across:
        yield _point(last.beam.at), _point(start)
    yield _point(start), _point(crossing.beam.at)


def _point(at: NDArray[np.float64]) -> Point:
    return float(at[0]), float(at[1])


def _begun(light: Light, crossing: Crossing) -> float:
    return 0.0 if crossing.before is None else light.crossings[crossing.before].beam.length


def _strip(light: Light, source: str, width: int) -> NDArray[np.uint8]:
    """Return the radius along the brightest way of a source (height, width, 3)."""
    import cv2
    import numpy as np

    size = letters(width, None)
    height, left, right, top, foot = round(15 * size), 5 * size, width - 2 * size, 3.4 * size, 3.6 * size
    panel = np.full((height, width, 3), _PAPER, np.uint8)
    way = _brightest(light, source)
    far = way[-1].beam.length
    points = [(c, s, _radius(c, _begun(light, c), s)) for c in way for s in np.linspace(0.0, 1.0, _SAMPLES)]
    most = _rounded(max(r for _, _, r in points))
    floor = height - foot

    def place(length: float, radius: float) -> tuple[float, float]:
        return left + (right - left) * length / far, floor - (floor - top) * radius / most

    def pixel(length: float, radius: float) -> tuple[int, int]:
        u, v = place(length, radius)
        return round(u), round(v)

    write(panel, f"beam radius of {source} along its main path [mm]", (left, 1.6 * size), size, _INK, weight=600)
    for part in (0.0, 0.5, 1.0):
        u, v = pixel(0.0, part * most)
        cv2.line(panel, (u, v), (round(right), v), _RULE, 1)
        write(panel, f"{part * most:.3g}", (left - 0.5 * size, v + 0.35 * size), 0.9 * size, _FAINT, align="right")
    line = np.array([place(_begun(light, c) + s * (c.beam.length - _begun(light, c)), r) for c, s, r in points])
    fine = np.round(line * 2**_BITS).astype(np.int32)
    cv2.polylines(panel, [fine.reshape(-1, 1, 2)], False, _BEAM, 2, cv2.LINE_AA, _BITS)
    used = -math.inf
    for crossing in way:
        u, _ = pixel(crossing.beam.length, 0.0)
        cv2.line(panel, (u, round(top)), (u, round(floor)), _RULE, 1)
        row = 1.3 if u - used > 4.5 * size else 2.6
        used = u if row == 1.3 else used
        write(panel, crossing.component or "edge", (u, floor + row * size), 0.9 * size, _INK, align="center")
    return panel


def _brightest(light: Light, source: str) -> tuple[Crossing, ...]:
    """Return the way on which most of the light is detected; where none is, the longest."""
    mine = [n for n, c in enumerate(light.crossings) if c.beam.source == source and not c.beam.ghost]
    last = max(mine, key=lambda n: (light.crossings[n].event == "detected", light.crossings[n].power, n))
    if light.crossings[last].event != "detected":
        last = max(mine, key=lambda n: light.crossings[n].beam.length)
    return light.way(last)


def _radius(crossing: Crossing, begun: float, share: float) -> float:
    from pico.optics.beam import forward

    back = (1 - share) * (crossing.beam.length - begun)
    radius: float = forward(crossing.beam, -back).widths[0]
    return radius


def _rounded(value: float) -> float:
    """Return a round number that is not less."""
    step = 10.0 ** math.floor(math.log10(value))
    return next(m * step for m in (1, 1.5, 2, 3, 5, 7.5, 10) if m * step >= value)
