"""A joint trajectory of our own timing: where it is at a time, and its corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

STRAIGHT = 1e-3
"""What a stretch may bend and still be driven as one move of the control box [rad]."""


@dataclass(frozen=True, slots=True)
class Path:
    """Joints (n, 7) [rad] at times (n,) from 0 [s], straight in between."""

    times: np.ndarray
    joints: np.ndarray

    @property
    def seconds(self) -> float:
        return float(self.times[-1])

    def at(self, time: float) -> list[float]:
        """Return the joints at `time` [rad]; before and after the path its ends."""
        return [float(np.interp(time, self.times, column)) for column in self.joints.T]

    def corners(self, straight: float = STRAIGHT) -> list[int]:
        """Return which of its points a polyline needs that stays within `straight` [rad] of it, first and last
        included."""
        kept, open_ = {0, len(self.times) - 1}, [(0, len(self.times) - 1)]
        while open_:
            first, last = open_.pop()
            if last - first < 2:
                continue
            off = _off_line(self.joints[first : last + 1])
            worst = int(np.argmax(off))
            if off[worst] > straight:
                kept.add(first + worst)
                open_ += [(first, first + worst), (first + worst, last)]
        return sorted(kept)


def _off_line(points: np.ndarray) -> np.ndarray:
    """How far each point is from the line between the first and the last (n,)."""
    line = points[-1] - points[0]
    length = float(np.linalg.norm(line))
    if length == 0.0:
        return np.asarray(np.linalg.norm(points - points[0], axis=1))
    along = np.clip((points - points[0]) @ line / length**2, 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - points[0] - along[:, None] * line, axis=1))
