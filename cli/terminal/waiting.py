"""What takes more than a second says so: one line on a terminal that is overwritten, and gone in the end."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from .output import write

PATIENCE = 1.0
"""Seconds that nobody minds."""
_BEAT = 0.2
_BAR = 24


class Waiting:
    """What is being done, and how much of it is done already where that is known (0 to 1)."""

    def __init__(self, what: str) -> None:
        self.what, self.share = what, 0.0
        self._begun, self._over = time.monotonic(), threading.Event()
        self._shown = False
        self._thread = threading.Thread(target=self._tick, name="pico waiting", daemon=True)

    def line(self, elapsed: float) -> str:
        """Return the line after `elapsed` seconds."""
        if self.share <= 0:
            return f"{self.what} ... {elapsed:.0f} s"
        full = round(self.share * _BAR)
        left = elapsed * (1 - self.share) / self.share
        return f"{self.what} [{'#' * full}{'.' * (_BAR - full)}] {100 * self.share:3.0f} %, {left:.0f} s left"

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._over.set()
        self._thread.join()
        if self._shown:
            write(sys.stderr, "", end="", over=True)

    def _tick(self) -> None:
        while not self._over.wait(_BEAT):
            elapsed = time.monotonic() - self._begun
            if elapsed >= PATIENCE:
                self._shown = True
                write(sys.stderr, self.line(elapsed), end="", over=True)


@contextmanager
def waiting(what: str) -> Iterator[Waiting]:
    """While something goes on, say so on standard error where that is a terminal; set its `share` as it goes on."""
    found = Waiting(what)
    shown = sys.stderr.isatty()
    if shown:
        found.start()
    try:
        yield found
    finally:
        if shown:
            found.stop()
