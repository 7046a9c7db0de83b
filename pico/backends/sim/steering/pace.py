"""Wall time for a simulated world that a person steers: no moment of it comes sooner than a clock on the wall says."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

LATE = 0.25
"""A world that is later than this is not hurried after the wall clock [s]. One that is less late is, so that a step is
over when it should be by the wall, as a real one would be."""
TICK = 0.01
"""Longest time between two looks at the clock [s]."""
STEP = 0.02
"""Simulated seconds in which a motion is walked in one go while the world keeps pace."""


@dataclass
class Pace:
    """`factor`: simulated seconds in one of the wall; None lets the world run as fast as the machine can."""

    factor: float | None = 1.0
    clock: Callable[[], float] = time.monotonic
    _wall: float = 0.0
    _now: float = 0.0

    def begin(self, now: float) -> None:
        """Let the moment `now` of the world be this one on the wall."""
        self._wall, self._now = self.clock(), now

    def moment(self, now: float) -> float:
        """Return which moment of the world it is by the wall, where it stood still since `now` was; not before that."""
        if self.factor is None:
            return now
        return max(now, self._now + (self.clock() - self._wall) * self.factor)

    def left(self, moment: float) -> float:
        """Return how long it is until a moment of the world [s of the wall]; 0 where it is due."""
        if self.factor is None:
            return 0.0
        left = (moment - self._now) / self.factor - (self.clock() - self._wall)
        if left < -LATE:
            self.begin(moment)
        return max(0.0, left)
