"""What is written beside the guard: who has something to keep or to tell never waits for a disk or a lock."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue


class Aside:
    """Does calls one after another in a thread of its own."""

    def __init__(self, name: str) -> None:
        self._calls: SimpleQueue[Callable[[], object]] = SimpleQueue()
        self._name = name
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()

    def do(self, call: Callable[[], object]) -> None:
        """Have a call done after all that was given before; returns at once."""
        with self._lock:
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, daemon=True, name=self._name)
                self._thread.start()
        self._calls.put(call)

    def finish(self, within: float) -> bool:
        """Wait until all is done that was given, `within` seconds at most; returns whether it is."""
        if self._thread is None:
            return True
        done = threading.Event()
        self._calls.put(done.set)
        return done.wait(within)

    def _work(self) -> None:
        while True:
            call = self._calls.get()
            with suppress(Exception):  # what can't be told must not keep the next from being told
                call()
