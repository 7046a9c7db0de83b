"""The exposure at which a camera tells most: not saturated, and not dark. For every device that takes pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

GOOD = (0.5, 0.85)
"""The share of full scale that the brightest pixel is to read."""
_AIM, _STEP = 0.7, 20.0
MOST = 8
"""Frames that are taken at most."""


@dataclass(frozen=True)
class Taken:
    """A frame that was taken: at an exposure [ms], and how bright it was, as a share of full scale above black."""

    exposure: float
    level: float


def next_exposure(taken: Taken, limits: tuple[float, float]) -> float | None:
    """Return the exposure to try next [ms]; None where this one is good, or the camera can't do better."""
    if GOOD[0] <= taken.level <= GOOD[1]:
        return None
    factor = 1 / _STEP if taken.level >= 0.99 else min(_AIM / max(taken.level, 1e-6), _STEP)
    low, high = limits
    wanted = min(max(round(taken.exposure * factor, 3), low), high)  # rounded first: a limit may be finer
    return None if wanted == taken.exposure else wanted


def brightest(pixels: NDArray[Any]) -> float:
    """Return the brightest place of a frame (h, w) of counts, where a hot pixel is none: the middle of 3 x 3 pixels."""
    import cv2

    return float(cv2.medianBlur(pixels, 3).max())


def level_of(peak: float, black: float, full: float) -> float:
    """Return how bright a frame is whose brightest pixel reads `peak`, as a share of full scale above black."""
    return max(0.0, peak - black) / (full - black)
