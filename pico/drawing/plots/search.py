"""How an optimization went: what was measured, and how its tunables were set, measurement by measurement."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from pico.twin.lettering import extent, write

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_PAPER, _INK, _FAINT, _RULE = (252, 252, 253), (34, 40, 49), (126, 134, 146), (222, 226, 232)
_COLORS = ((58, 138, 196), (224, 110, 36), (52, 136, 108), (128, 92, 182), (176, 132, 44), (188, 58, 50))
_LEFT, _RIGHT, _TOP, _FOOT, _HEIGHT = 110, 190, 40, 36, 190


def search_plot(
    title: str, columns: Sequence[str], points: NDArray[np.float64], outputs: Mapping[str, float | None],
    units: Mapping[str, str], *, width: int = 960,
) -> NDArray[np.uint8]:  # fmt: skip
    """Return the plot (height, width, 3), sRGB: a panel for each output, with its standard deviations and, where it has
    one, its target; and one for the tunables, each over its own range. `points` (n, columns)."""
    import numpy as np

    names = [c for c in columns if c != "time" and not c.endswith("_sigma")]
    tunables = [c for c in names if c not in outputs]
    panels = [*([name] for name in outputs), tunables]
    image = np.full((_TOP + len(panels) * (_HEIGHT + _FOOT), width, 3), _PAPER, np.uint8)
    write(image, title, (16, 27), 17, _INK, weight=600)
    for row, panel in enumerate(panels):
        top = _TOP + row * (_HEIGHT + _FOOT)
        _frame(image, top, width, len(points))
        for number, name in enumerate(panel):
            values = points[:, columns.index(name)]
            target = outputs.get(name)
            low, high = _limits(values, target)
            if name in outputs or number == 0:
                _scale(image, top, low, high, units.get(name, ""), len(panel) == 1)
            color = _COLORS[(number + (0 if name in outputs else 1)) % len(_COLORS)]
            sigma = points[:, columns.index(f"{name}_sigma")] if f"{name}_sigma" in columns else None
            _line(image, top, width, values, (low, high), color, sigma)
            if target is not None:
                y = _row(top, target, low, high)
                image[y, _LEFT : width - _RIGHT : 3] = _FAINT
            _label(image, name, (width - _RIGHT + 8, top + 16 + 40 * number), color)
            if len(panel) > 1:
                ends = f"{np.nanmin(values):.4g} to {np.nanmax(values):.4g} {units.get(name, '')}".rstrip()
                _label(image, ends, (width - _RIGHT + 8, top + 32 + 40 * number), _FAINT)
    foot = "measurement"
    write(image, foot, (width - _RIGHT, len(image) - 8), 12, _FAINT, align="right", weight=500)
    return image


def _limits(values: NDArray[np.float64], target: float | None) -> tuple[float, float]:
    found = [v for v in values.tolist() if math.isfinite(v)] + ([target] if target is not None else [])
    low, high = (min(found), max(found)) if found else (0.0, 1.0)
    room = 0.08 * (high - low) or abs(high) * 0.1 or 1.0
    return low - room, high + room


def _frame(image: NDArray[np.uint8], top: int, width: int, count: int) -> None:
    image[top : top + _HEIGHT, _LEFT] = _RULE
    image[top + _HEIGHT, _LEFT : width - _RIGHT] = _RULE
    every = max(1, round(count / 10))
    for n in range(0, count, every):
        x = _column(n, count, width)
        image[top + _HEIGHT : top + _HEIGHT + 4, x] = _RULE
        write(image, str(n + 1), (x, top + _HEIGHT + 18), 12, _FAINT, align="center", weight=500)


def _label(image: NDArray[np.uint8], text: str, at: tuple[int, int], color: tuple[int, int, int]) -> None:
    while extent(text, 12, 500)[0] > _RIGHT - 12 and len(text) > 4:
        text = f"{text[:-2]}…"
    write(image, text, at, 12, color, weight=500)


def _scale(image: NDArray[np.uint8], top: int, low: float, high: float, unit: str, numbered: bool) -> None:
    for share in (0.1, 0.5, 0.9):
        value = low + share * (high - low)
        text = f"{value:.3g} {unit}".rstrip() if numbered else ""
        y = _row(top, value, low, high)
        image[y, _LEFT - 4 : _LEFT] = _RULE
        write(image, text, (_LEFT - 8, y + 4), 12, _FAINT, align="right", weight=500)


def _line(
    image: NDArray[np.uint8], top: int, width: int, values: NDArray[np.float64], limits: tuple[float, float],
    color: tuple[int, int, int], sigma: NDArray[np.float64] | None,
) -> None:  # fmt: skip
    import cv2

    last: tuple[int, int] | None = None
    for n, value in enumerate(values.tolist()):
        x = _column(n, len(values), width)
        if not math.isfinite(value):
            cv2.drawMarker(image, (x, top + _HEIGHT - 6), _FAINT, cv2.MARKER_TILTED_CROSS, 7, 1, cv2.LINE_AA)
            last = None
            continue
        at = (x, _row(top, value, *limits))
        if sigma is not None and math.isfinite(sigma[n]) and sigma[n] > 0:
            ends = [_row(top, value + s * sigma[n], *limits) for s in (-1, 1)]
            cv2.line(image, (x, ends[0]), (x, ends[1]), color, 1, cv2.LINE_AA)
        if last is not None:
            cv2.line(image, last, at, color, 1, cv2.LINE_AA)
        cv2.circle(image, at, 3, color, -1, cv2.LINE_AA)
        last = at


def _column(n: int, count: int, width: int) -> int:
    return round(_LEFT + 14 + (width - _RIGHT - _LEFT - 28) * (n / (count - 1) if count > 1 else 0.5))


def _row(top: int, value: float, low: float, high: float) -> int:
    return round(min(top + _HEIGHT, max(top, top + _HEIGHT * (1 - (value - low) / (high - low)))))
