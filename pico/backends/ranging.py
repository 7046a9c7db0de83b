"""The exposure at which a camera tells most: not saturated, and not dark. For every device that takes pictures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.diagnostics import Diagnostic, error

if TYPE_CHECKING:
    from numpy.typing import NDArray

GOOD = (0.5, 0.85)
"""The share of full scale that the brightest pixel is to read."""
FULL, DARK = 0.99, 0.02
"""From which share on a frame is saturated, and up to which it shows nothing but noise."""
_AIM, _STEP = 0.7, 20.0
_NOISE = 7.0
"""Median deviations by which the brightest of a million dark pixels stands out: five standard deviations."""
_MOST_UNSATURATED = 0.98
MOST = 8
"""Frames that are taken at most."""


@dataclass(frozen=True)
class Taken:
    """A frame that was taken: at an exposure [ms], and how bright it was, as a share of full scale above black."""

    exposure: float
    level: float


def first_exposure(limits: tuple[float, float]) -> float:
    """Return the exposure to begin with [ms] if that of the camera is unknown: in the middle of its decades."""
    low, high = limits
    return float(f"{math.sqrt(low * high):.4g}") if low > 0 and high < math.inf else max(low, 1.0)


def next_exposure(taken: Taken, limits: tuple[float, float]) -> float | None:
    """Return the exposure to try next [ms]; None where this one is good, or the camera can't do better."""
    if GOOD[0] <= taken.level <= GOOD[1]:
        return None
    factor = 1 / _STEP if taken.level >= FULL else min(_AIM / max(taken.level, 1e-6), _STEP)
    low, high = limits
    wanted = min(max(float(f"{taken.exposure * factor:.4g}"), low), high)  # rounded first: a limit may be finer
    return None if wanted == taken.exposure else wanted


def in_vain(name: str, frames: Sequence[Taken]) -> Diagnostic | None:
    """Return why no exposure of a camera shows its light: too much, or none; None where the last frame does."""
    last = frames[-1]
    if last.level >= FULL:
        was = frames[0].exposure
        left = f"; the exposure stays there, it was {was:g} ms" if was != last.exposure else ""
        text = f"{name} is saturated even at {last.exposure:g} ms, its shortest exposure{left}"
        return error("saturated", text, hint="weaken the beam: a filter, a wave plate before a polarizer", address=name)
    if last.level < DARK:
        text = f"no light comes to {name}: its picture stays dark up to {last.exposure:g} ms"
        return error("dark", text, hint="`pico beam` shows where the beams go, and which lasers are shut", address=name)
    return None


def taken(exposure: float, pixels: NDArray[Any], black: float, full: float) -> Taken:
    """Return how bright a frame (h, w) of counts is, by the rule of the kernels: full if these would call it saturated,
    else its brightest pixel, defective ones left out."""
    import numpy as np

    from pico.kernels.defects import median
    from pico.kernels.frame import Frame

    frame = Frame(pixels, full_scale=full, black_level=black)
    if frame.saturated:
        return Taken(exposure, 1.0)
    some = frame.signal[::4, ::4]
    noise = _NOISE * float(median(np.abs(some - median(some))))
    return Taken(exposure, min(max(0.0, float(frame.signal.max()) - noise) / (full - black), _MOST_UNSATURATED))
