"""The private thread with the event loop in which an edge lives; nothing else runs there."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Coroutine
from concurrent.futures import Future, wait
from typing import Any, TypeVar

from pico.diagnostics import PicoError, error

T = TypeVar("T")

HEED = 0.2
"""Seconds after which a signal is heard that the system gave to another thread than the main one, which hears it."""

ENDING = 1.0
"""Seconds that what is under way there has to end by itself once the thread is to end, and then to break off."""


class LoopThread:
    """A thread that runs coroutines; started when it is first needed."""

    def __init__(self) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self._lock = threading.Lock()
        self._busy: set[Future[Any]] = set()
        self.left_busy = False
        """Whether somebody stopped waiting for what the thread still does."""
        self._process = 0

    @property
    def elsewhere(self) -> bool:
        """Whether the thread was left in another process, of which this one was forked."""
        return self._loop is not None and self._process != os.getpid()

    def require_here(self) -> None:
        """Raise PicoError where the thread was left in another process: nothing would ever come of waiting for it."""
        if self.elsewhere:
            text = f"this bench was opened in process {self._process}, of which this one was forked"
            hint = "open it anew here: `pico.open(...)`; or let one process do what moves the bench"
            raise PicoError(error("forked", text, hint=hint))

    def submit(self, work: Coroutine[Any, Any, T]) -> Future[T]:
        """Start a coroutine and return its future, which is kept meanwhile: a loop alone does not keep what waits for
        another process from the garbage collector."""
        with self._lock:
            if self._loop is None:
                self._loop, self._process = asyncio.new_event_loop(), os.getpid()
                threading.Thread(target=self._loop.run_forever, name="pico bench", daemon=True).start()
            future = asyncio.run_coroutine_threadsafe(work, self._loop)
        self._busy.add(future)
        future.add_done_callback(self._busy.discard)
        return future

    def wait(self, work: Coroutine[Any, Any, T]) -> T:
        """Run a coroutine and return its result, or raise what it raises; Ctrl-C ends the waiting at once."""
        if self.elsewhere:
            work.close()
        self.require_here()
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
        """End the thread, and what still waits there: nobody hears of it otherwise."""
        if self._loop is None:
            return
        if not self.left_busy:
            self.wait(_ended())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._loop = None


async def _ended() -> None:
    """Let everything else in this loop end: by itself where it is at its end, else by breaking it off."""
    others = asyncio.all_tasks() - {asyncio.current_task()}
    for _ in range(3):  # the last breaks off, too, how a run is brought to its end
        if others:
            _, others = await asyncio.wait(others, timeout=ENDING)
        for task in others:
            task.cancel()
