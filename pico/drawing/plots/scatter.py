"""One measured number against another: as a picture, and as text for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.twin.lettering import write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Color = tuple[int, int, int]

_PAPER, _INK, _FAINT, _RULE = (252, 252, 253), (34, 40, 49), (126, 134, 146), (222, 226, 232)
_POINT = (58, 138, 196)
_LEFT, _RIGHT, _TOP, _FOOT = 96, 24, 66, 56
WIDTH, HEIGHT = 72, 18
"""Characters of a plot in a terminal."""


@dataclass(frozen=True)
class Points:
    """Points (x, y), each with the standard deviation of y (None where nobody tells): names and units of the axes."""

    x: tuple[float, ...]
    y: tuple[float, ...]
    sigma: tuple[float | None, ...]
    x_name: str
    y_name: str
    x_unit: str = ""
    y_unit: str = ""

    @property
    def x_label(self) -> str:
        """`p1.angle [deg]`."""
        return f"{self.x_name} [{self.x_unit}]" if self.x_unit else self.x_name

    @property
    def y_label(self) -> str:
        """`cam.centroid.x [um]`."""
        return f"{self.y_name} [{self.y_unit}]" if self.y_unit else self.y_name

    def limits(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return what the axes show, with room around the points and their standard deviations."""
        high = [y + (s or 0.0) for y, s in zip(self.y, self.sigma, strict=True)]
        low = [y - (s or 0.0) for y, s in zip(self.y, self.sigma, strict=True)]
        return _roomy(min(self.x), max(self.x)), _roomy(min(low), max(high))


def picture(title: str, points: Points, *, width: int = 800, height: int = 480) -> NDArray[np.uint8]:
    """Return the plot (height, width, 3), sRGB; with at least one point."""
    import cv2
    import numpy as np

    image = np.full((height, width, 3), _PAPER, np.uint8)
    write(image, title, (16, 27), 17, _INK, weight=600)
    (x0, x1), (y0, y1) = points.limits()
    right, foot = width - _RIGHT, height - _FOOT
    image[_TOP:foot, _LEFT] = _RULE
    image[foot, _LEFT:right] = _RULE

    def column(x: float) -> int:
        return round(_LEFT + (right - _LEFT) * (x - x0) / (x1 - x0))

    def row(y: float) -> int:
        return round(foot - (foot - _TOP) * (y - y0) / (y1 - y0))

    for x in ticks(x0, x1):
        image[foot : foot + 5, column(x)] = _RULE
        write(image, f"{x:.6g}", (column(x), foot + 19), 12, _FAINT, align="center", weight=500)
    for y in ticks(y0, y1):
        image[row(y), _LEFT - 5 : right : 3] = _RULE
        write(image, f"{y:.6g}", (_LEFT - 9, row(y) + 4), 12, _FAINT, align="right", weight=500)
    write(image, points.x_label, (right, height - 12), 13, _INK, align="right", weight=500)
    write(image, points.y_label, (_LEFT - 80, _TOP - 14), 13, _INK, weight=500)
    for x, y, sigma in zip(points.x, points.y, points.sigma, strict=True):
        if sigma:
            cv2.line(image, (column(x), row(y - sigma)), (column(x), row(y + sigma)), _POINT, 1, cv2.LINE_AA)
        cv2.circle(image, (column(x), row(y)), 4, _POINT, -1, cv2.LINE_AA)
    return image


def text(title: str, points: Points, *, width: int = WIDTH, height: int = HEIGHT) -> str:
    """Return the plot as lines of a terminal, `width` characters wide; several points in one place are a number."""
    (x0, x1), (y0, y1) = points.limits()
    wide, high = width - 12, height
    counts = [[0] * wide for _ in range(high)]
    for x, y in zip(points.x, points.y, strict=True):
        column = min(wide - 1, int(wide * (x - x0) / (x1 - x0)))
        counts[high - 1 - min(high - 1, int(high * (y - y0) / (y1 - y0)))][column] += 1
    lines = [title, points.y_label]
    for n, line in enumerate(counts):
        said = f"{y1 - (n + 0.5) * (y1 - y0) / high:.5g}" if n % 5 == 0 else ""
        dots = "".join(" " if c == 0 else "•" if c == 1 else str(min(c, 9)) for c in line)
        lines.append(f"{said:>10} │{dots}".rstrip())
    lines.append(f"{'':>10} └{'─' * wide}")
    first, last = f"{x0:.5g}", f"{x1:.5g}"
    lines.append(f"{'':>11}{first}{points.x_label:^{max(0, wide - len(first) - len(last))}}{last}")
    return "\n".join(lines)


def ticks(low: float, high: float) -> Iterator[float]:
    """Yield round numbers between two, about five."""
    step = 10.0 ** math.floor(math.log10((high - low) / 5))
    step *= next(m for m in (1, 2, 5, 10) if (high - low) / (step * m) <= 6)
    first = math.ceil(low / step)
    yield from (n * step for n in range(first, math.floor(high / step) + 1))


def _roomy(low: float, high: float) -> tuple[float, float]:
    room = 0.06 * (high - low) or abs(high) * 0.05 or 1.0
    return low - room, high + room


def of_columns(
    x: Sequence[object], y: Sequence[object], sigma: Sequence[object], names: tuple[str, str], units: tuple[str, str]
) -> Points:
    """Return the points of two columns, and the standard deviations of the second, as far as both are finite numbers;
    raises ValueError where none is."""
    rows = [
        (float(a), float(b), float(s) if _number(s) else None)  # type: ignore[arg-type]
        for a, b, s in zip(x, y, sigma, strict=True)
        if _number(a) and _number(b)
    ]
    if not rows:
        raise ValueError(f"{names[1]} was never measured beside {names[0]}")
    xs, ys, sigmas = zip(*rows, strict=True)
    return Points(xs, ys, sigmas, *names, *units)


def _number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
