"""A joint trajectory of our own timing: where it is at a time, whether an arm may follow it, and its corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pico.diagnostics import PicoError, error
from pico.drivers.xarm.settings import XArmSettings

_BEYOND = 1e-3  # rad
_FASTER = 1.02  # a share more than the limit is rounding of the planner's own limit
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


def checked(name: str, times: np.ndarray, joints: np.ndarray, settings: XArmSettings) -> Path:
    """Return a path from time 0; raises PicoError, with all that is wrong, where an arm may not follow it."""
    times, joints = np.asarray(times, float), np.asarray(joints, float)
    if times.ndim != 1 or joints.shape != (len(times), 7) or not len(times):
        text = f"{name} follows n times and n postures of 7 joints, not {times.shape} and {joints.shape}"
        raise PicoError(error("arm-path", text, address=name))
    wrong = []
    if not (np.isfinite(times).all() and np.isfinite(joints).all() and (np.diff(times) > 0).all()):
        wrong.append("its times do not grow, or it has values that are no numbers")
    for number, (low, high) in enumerate(settings.ranges, 1):
        column = joints[:, number - 1]
        if column.min() < low - _BEYOND or column.max() > high + _BEYOND:
            wrong.append(f"joint {number} goes to {_farthest(column, low, high):.1f} deg, beyond its limits")
    if len(times) > 1 and not wrong:
        fastest = float(np.max(np.abs(np.diff(joints, axis=0)) / np.diff(times)[:, None]))
        if fastest > settings.joint_speed * _FASTER:
            limit = np.degrees(settings.joint_speed)
            wrong.append(f"a joint turns at {np.degrees(fastest):.0f} deg/s, more than {limit:.0f} deg/s")
    if wrong:
        hint = "plan it again with the limits of the `device:` entry"
        raise PicoError([error("arm-path", f"{name} can't follow a path: {w}", hint=hint, address=name) for w in wrong])
    return Path(times - times[0], joints)


def _farthest(column: np.ndarray, low: float, high: float) -> float:
    return float(np.degrees(column.max() if column.max() > high + _BEYOND else column.min()))
