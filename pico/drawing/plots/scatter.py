"""One measured number against another: as a picture, and as text for a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.drawing.plots.axes import COLORS, Axes, paper, roomy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

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
        return roomy(min(self.x), max(self.x)), roomy(min(low), max(high))


def picture(title: str, points: Points, *, width: int = 800, height: int = 480) -> NDArray[np.uint8]:
    """Return the plot (height, width, 3), sRGB; with at least one point."""
    image = paper(title, width, height)
    axes = Axes(image, _LEFT, width - _RIGHT, _TOP, height - _FOOT, *points.limits())
    axes.frame(points.x_label, points.y_label)
    axes.points(points.x, points.y, points.sigma, COLORS[0])
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
