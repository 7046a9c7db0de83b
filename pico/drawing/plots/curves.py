"""What was found beside what theory says: points with their standard deviations, theory as lines, residuals below."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pico.drawing.plots.axes import COLORS, INK, Axes, paper, roomy
from pico.twin.lettering import write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_LEFT, _RIGHT, _TOP, _FOOT, _BELOW, _LINE = 96, 24, 66, 56, 120, 18


@dataclass(frozen=True)
class Curve:
    """Points (x, y) of one series, each with its standard deviation and what theory says of it (none for nobody
    knows)."""

    label: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    sigma: tuple[float, ...] = ()
    theory: tuple[float, ...] = ()

    @property
    def bars(self) -> tuple[float | None, ...]:
        """Its standard deviations, None where nobody knows."""
        return self.sigma or (None,) * len(self.x)

    @property
    def off(self) -> tuple[float, ...]:
        """By how much each point differs from theory."""
        return tuple(y - t for y, t in zip(self.y, self.theory, strict=True)) if self.theory else ()

    @property
    def said(self) -> str:
        """Its label, and how well it agrees with theory: chi-squared over the number of points."""
        if not (self.sigma and self.theory and all(self.sigma)):
            return self.label
        sigmas = [d / s for d, s in zip(self.off, self.sigma, strict=True)]
        near, mean = sum(abs(n) <= 2 for n in sigmas), sum(n * n for n in sigmas) / len(sigmas)
        return f"{self.label}: {near} of {len(sigmas)} within 2 sigma, chi2/n {mean:.2f}"


def picture(
    title: str, x_label: str, y_label: str, curves: Sequence[Curve], notes: Sequence[str] = (), *, width: int = 860,
    height: int = 460,
) -> NDArray[np.uint8]:  # fmt: skip
    """Return the plot (h, width, 3), sRGB, with a panel for residuals where there is theory, and `notes` at its foot;
    with at least one point."""
    compared = [curve for curve in curves if curve.theory]
    legend = len(curves) * _LINE
    whole = height + legend + (_BELOW + _FOOT if compared else 0)
    image = paper(title, width, whole, notes)
    x = roomy(min(v for c in curves for v in c.x), max(v for c in curves for v in c.x))
    top = _TOP + legend
    main = Axes(image, _LEFT, width - _RIGHT, top, height + legend - _FOOT, x, _range(curves))
    main.frame("" if compared else x_label, y_label, numbered=not compared)
    for n, curve in enumerate(curves):
        color = COLORS[n % len(COLORS)]
        image[42 + n * _LINE : 50 + n * _LINE, 18:26] = color
        write(image, curve.said, (34, 51 + n * _LINE), 12, INK, weight=500)
        if curve.theory:
            main.line(curve.x, curve.theory, color)
        main.points(curve.x, curve.y, curve.bars, color)
    if compared:
        below = Axes(
            image, _LEFT, width - _RIGHT, main.foot + 44, main.foot + 44 + _BELOW, x, _range(compared, off=True)
        )
        below.frame(x_label, "less theory")
        below.line(x, (0.0, 0.0), INK)
        for n, curve in enumerate(curves):
            if curve.theory:
                below.points(curve.x, curve.off, curve.bars, COLORS[n % len(COLORS)])
    return image


def _range(curves: Sequence[Curve], *, off: bool = False) -> tuple[float, float]:
    ends = [
        y + way * (s or 0.0)
        for c in curves for y, s in zip(c.off if off else c.y, c.bars, strict=True) for way in (-1, 1)
    ]  # fmt: skip
    ends += [0.0] if off else [t for c in curves for t in c.theory]
    return roomy(min(ends), max(ends))
