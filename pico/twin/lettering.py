"""Text in pictures, in the TrueType face that OpenCV carries: the same bytes on every machine."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Align = Literal["left", "center", "right"]
Color = tuple[int, int, int]


@cache
def _face() -> Any:
    import cv2

    return cv2.FontFace("sans")


def extent(text: str, size: float, weight: int = 400) -> tuple[int, int, int]:
    """Return width of `text`, its height above the base line, and its depth below [pixels] at `size` [pixels]."""
    import cv2

    x, y, width, height = cv2.getTextSize((4096, 4096), text, (0, 0), _face(), round(size), weight)
    return int(x + width), int(-y), int(y + height)


def write(
    image: NDArray[np.uint8],
    text: str,
    at: tuple[float, float],
    size: float,
    color: Color,
    *,
    align: Align = "left",
    weight: int = 400,
) -> None:
    """Write `text` into `image` (h, w, 3), its base line at `at` (u, v) [pixels]."""
    import cv2

    if size < 4:
        return
    shift = {"left": 0.0, "center": 0.5, "right": 1.0}[align] * extent(text, size, weight)[0]
    origin = (round(at[0] - shift), round(at[1]))
    cv2.putText(image, text, origin, color, _face(), round(size), weight)
