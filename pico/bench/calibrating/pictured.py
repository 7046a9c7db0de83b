"""Pictures of the steps of a calibration, for the person who makes it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.drawing.picture import write_png

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_WIDTH = 1200
_COLORS = ((60, 200, 90), (230, 140, 40))


def corners_drawn(gray: Any, points: Sequence[Array], path: Path, also: Sequence[Array] = ()) -> None:
    """Write a picture (rows, columns) with `points` (n, 2) [pixels] marked in green, and `also` in orange."""
    import cv2
    import numpy as np

    share = min(1.0, _WIDTH / gray.shape[1])
    small = cv2.resize(gray, (round(gray.shape[1] * share), round(gray.shape[0] * share)), interpolation=cv2.INTER_AREA)
    image: Any = np.repeat(np.asarray(small, np.uint8)[..., None], 3, axis=2).copy()
    for color, groups in zip(_COLORS, (points, also), strict=True):
        for group in groups:
            for u, v in np.asarray(group) * share:
                cv2.circle(image, (round(float(u)), round(float(v))), 3, color, 1, cv2.LINE_AA)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_png(image, path)


def readings_drawn(nominal: Sequence[float], read: Sequence[float], fitted: Sequence[float], path: Path) -> None:
    """Write a chart of what the scale of an axis showed over what its device says, with what was fitted."""
    import cv2
    import numpy as np

    size, edge = 480, 40
    image: Any = np.full((size, size, 3), 255, np.uint8)
    cv2.rectangle(image, (edge, edge), (size - edge, size - edge), (120, 120, 120), 1)
    low, high = min(nominal), max(nominal)
    bottom, top = min(*read, *fitted), max(*read, *fitted)

    def at(x: float, y: float) -> tuple[int, int]:
        u = edge + (x - low) / ((high - low) or 1.0) * (size - 2 * edge)
        v = size - edge - (y - bottom) / ((top - bottom) or 1.0) * (size - 2 * edge)
        return round(u), round(v)

    for x, y, line in zip(nominal, read, fitted, strict=True):
        cv2.circle(image, at(x, y), 6, _COLORS[0], 2, cv2.LINE_AA)
        cv2.drawMarker(image, at(x, line), _COLORS[1], cv2.MARKER_TILTED_CROSS, 10, 1, cv2.LINE_AA)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_png(image, path)
