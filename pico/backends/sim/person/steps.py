"""The simulated person who carries out the steps by hand: how well a hand puts a part down, and turns a screw.

A step goes by looks: a part is put down beside its goal by PLACED and TURNED, then nudged, each time as far as it is
seen to be off, within NUDGED of that way. A screw is turned likewise: each turn errs by NUDGED of itself.
"""

from __future__ import annotations

import random

from pico.model.catalog import PoseTolerance, Tunable
from pico.model.pose import Pose, angle_between, wrap
from pico.model.quantities import Value

PLACED, TURNED = 0.5, 1.0
"""Standard deviation of where a hand puts a part down: each way [mm], and about the vertical [deg]."""
NUDGED = 0.1
"""Standard deviation of a nudge or of the turn of a screw, as a share of it."""
FINEST = 0.02, 0.02
"""The finest that a part is nudged by hand [mm, deg]."""
LOOKS = 6
"""After so many looks a person leaves a part, or a screw, as it is."""


def put(goal: Pose, tolerance: PoseTolerance, draw: random.Random) -> Pose:
    """Return where a part stands that a person put down at `goal`, and nudged until it stands there within
    `tolerance`."""
    at = Pose(goal.x + draw.gauss(0, PLACED), goal.y + draw.gauss(0, PLACED), wrap(goal.yaw + draw.gauss(0, TURNED)))
    for _ in range(LOOKS):
        if _stands(at, goal, tolerance):
            break
        at = Pose(
            _nearer(at.x, goal.x, FINEST[0], draw), _nearer(at.y, goal.y, FINEST[0], draw),
            wrap(goal.yaw - _nearer(angle_between(at.yaw, goal.yaw), 0.0, FINEST[1], draw)),
        )  # fmt: skip
    return at


def turn(kind: Tunable, start: Value | None, goal: Value, draw: random.Random) -> Value:
    """Return what a tunable reads once a person has set it to `goal`, from `start` (None if it could not be read)."""
    if kind.datatype != "float" or not isinstance(goal, int | float) or isinstance(goal, bool):
        return goal
    known = isinstance(start, int | float) and not isinstance(start, bool)
    at = float(start) if known and start is not None else float(goal) + draw.gauss(0, NUDGED) * _span(kind)
    for _ in range(LOOKS):
        if abs(at - goal) <= kind.tolerance:
            break
        at = _nearer(at, float(goal), kind.resolution or 0.0, draw)
    low, high = kind.range or (at, at)
    return float(min(max(at, low), high))


def _nearer(at: float, goal: float, finest: float, draw: random.Random) -> float:
    return goal + draw.gauss(0, NUDGED) * abs(goal - at) + draw.uniform(-0.5, 0.5) * finest


def _stands(at: Pose, goal: Pose, tolerance: PoseTolerance) -> bool:
    return at.distance(goal) <= tolerance.position and abs(angle_between(goal.yaw, at.yaw)) <= tolerance.yaw


def _span(kind: Tunable) -> float:
    return kind.range[1] - kind.range[0] if kind.range else kind.tolerance
