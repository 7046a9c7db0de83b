"""What an edge of the frame takes of the moments of a beam near it. Needs numpy at its top: kernels import it inside
their functions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_FAR = 5.0
"""Standard deviations from which an edge takes less than a millionth."""
_ROUNDS = 12


def change(shape: tuple[int, int], total: float, moments: Array) -> Array:
    """Return by how much total and moments (6,) of a Gaussian beam differ from those of its part on a frame (h, w);
    `moments`: those of the part."""
    out = np.zeros(6)
    for axis, size in ((0, shape[1]), (1, shape[0])):
        middle, variance = float(moments[axis]), float(moments[2 + axis])
        slope = float(moments[4]) / variance
        for gap, sign in ((middle + 0.5, -1.0), (size - 0.5 - middle, 1.0)):
            lost, moved, wider = _lost(gap, variance)
            shift, spread = [sign * moved, slope * sign * moved], [wider, slope**2 * wider]
            order = slice(None, None, -1 if axis else 1)
            out += [lost * total, *shift[order], *spread[order], slope * wider]
    return out


def _lost(gap: float, variance: float) -> tuple[float, float, float]:
    """The share of its light that a Gaussian loses beyond an edge `gap` from the middle of the rest, whose variance is
    given; how far that middle is moved, and by how much the variance falls short."""
    moved, whole = 0.0, variance
    lost = 0.0
    for _ in range(_ROUNDS):
        deviation = math.sqrt(whole)
        far = (gap - moved) / deviation
        if far > _FAR:
            return 0.0, 0.0, 0.0
        inside = max(0.5 * math.erfc(-far / math.sqrt(2)), 0.5)
        ratio = math.exp(-(far**2) / 2) / math.sqrt(2 * math.pi) / inside
        lost, moved, whole = 1 / inside - 1, deviation * ratio, variance / max(1 - far * ratio - ratio**2, 0.2)
    return lost, moved, whole - variance
