"""The private thread with the event loop in which an edge lives; nothing else runs there."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine
from concurrent.futures import Future, wait
from typing import Any, TypeVar

T = TypeVar("T")

HEED = 0.2
"""Seconds after which a signal is heard that the system gave to another thread than the main one, which hears it."""


class LoopThread:
    """A thread that runs coroutines; started when it is first needed."""

    def __init__(self) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self.left_busy = False
        """Whether somebody stopped waiting for what the thread still does."""

    def submit(self, work: Coroutine[Any, Any, T]) -> Future[T]:
        """Start a coroutine and return its future."""
        if self._loop is None:
            self._loop = asyncio.new_event_loop()
            threading.Thread(target=self._loop.run_forever, name="pico bench", daemon=True).start()
        return asyncio.run_coroutine_threadsafe(work, self._loop)

    def wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Run a coroutine and return its result, or raise what it raises; Ctrl-C ends the waiting at once."""
        future: Future[T] | None = None
        try:
            future = self.submit(work)
            while not wait([future], HEED).done:
                pass
            return future.result()
        except KeyboardInterrupt:
            self.left_busy = future is None or not future.done()
            if future is not None:
                future.cancel()
            raise

    def close(self) -> None:
        """End the thread."""
        if self._loop is not None:
            self._loop.call_soon_threadsafe(self._loop.stop)
            self._loop = None
