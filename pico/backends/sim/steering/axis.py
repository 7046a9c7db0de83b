"""What a person steers on the simulated table: an axis in small steps, read back all the way."""

from __future__ import annotations

import math
from collections.abc import Iterator

from pico.backends.attempt import Failed
from pico.backends.sim.steering.pace import STEP
from pico.diagnostics import error
from pico.model.catalog import Tunable
from pico.model.diff import value_distance
from pico.teleop.frames import STEP_SECONDS

_ROOM = 1.01
"""A step of an axis may be longer than it goes in STEP_SECONDS by so much: rounding."""


def driven(address: str, kind: Tunable, start: float, goal: float) -> Iterator[tuple[float, float]]:
    """Yield the seconds until a reading, and what it then is, of an axis that goes from `start` to `goal` at its speed;
    what has none is there at once. Raises Failed where that is more than one step."""
    way = value_distance(kind, start, goal)
    speed = kind.axis.speed if kind.axis and kind.axis.speed > 0 else math.inf
    seconds = way / speed
    if seconds > STEP_SECONDS * _ROOM:
        text = f"{address} would take {seconds:.2g} s for that; one step takes {STEP_SECONDS:g} s at most"
        raise Failed(error("step", text, address=address))
    count = max(1, math.ceil(seconds / STEP))
    turn = goal - start
    if kind.period:
        turn = math.remainder(turn, kind.period)
    for n in range(1, count + 1):
        yield seconds / count, goal if n == count else start + turn * n / count
