"""A clock that stands still while this process does not run."""

from __future__ import annotations

import threading
from collections.abc import Callable


class Awake:
    """Counts the time in which this process itself was running: one that was starved or frozen blames no device for
    that, for what the device said meanwhile is not read yet. It is asked all the time; a pause counts as `longest` [s]
    at most, so that a lost link is noticed also while the process is starved again and again. `longest` is more than it
    takes between two looks. Threads may share one."""

    def __init__(self, clock: Callable[[], float], longest: float) -> None:
        self._clock, self._longest = clock, longest
        self._last, self._now, self._lock = clock(), 0.0, threading.Lock()

    def now(self) -> float:
        """Return the time [s]."""
        with self._lock:
            at = self._clock()
            self._now += min(at - self._last, self._longest)
            self._last = at
            return self._now
