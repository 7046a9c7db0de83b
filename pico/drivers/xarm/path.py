"""Whether an xArm may follow a joint trajectory."""

from __future__ import annotations

import numpy as np

from pico.diagnostics import PicoError, error
from pico.drivers.path import Path
from pico.drivers.xarm.settings import XArmSettings

_BEYOND = 1e-3  # rad
_FASTER = 1.02  # a share more than the limit is rounding of the planner's own limit


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
