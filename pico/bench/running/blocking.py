"""The synchronous side: coroutines on one private thread with an event loop, and a run that scripts iterate over."""

from __future__ import annotations

import asyncio
import queue
import threading
from collections.abc import Coroutine, Iterator
from concurrent.futures import Future, wait
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeVar

from pico.model.event import Event

if TYPE_CHECKING:
    from pico.bench.running.async_execution import AsyncExecution
    from pico.model.plan import Plan
    from pico.model.report import RunReport

T = TypeVar("T")

HEED = 0.2
"""Seconds after which a signal is heard that the system gave to another thread than the main one, which hears it."""


class LoopThread:
    """A thread that runs coroutines; started when it is first needed."""

    def __init__(self) -> None:
        self._loop: asyncio.AbstractEventLoop | None = None
        self.left_busy = False
        """Whether somebody stopped waiting for what the thread still does."""

    @property
    def started(self) -> bool:
        """Whether there is a thread yet."""
        return self._loop is not None

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


class Execution:
    """A plan to be run: an iterator over its events, which begins with the first; `report` once it is `over`.

    An exception in the caller between two events does not end the run: go on iterating, or `halt` it first;
    `attending.attend` does.
    """

    def __init__(self, run: AsyncExecution, thread: LoopThread) -> None:
        self._run, self._thread = run, thread
        self._queue: queue.SimpleQueue[Event | BaseException | None] = queue.SimpleQueue()
        self._begun = self.over = False

    @property
    def plan(self) -> Plan:
        """The plan that is run."""
        return self._run.plan

    @property
    def report(self) -> RunReport:
        """What became of the run; raises RuntimeError before it is over."""
        return self._run.report

    async def _pump(self) -> None:
        end: BaseException | None = None
        try:
            async for event in self._run:
                self._queue.put(event)
        except BaseException as exc:
            end = exc
        self._queue.put(end)

    def __iter__(self) -> Iterator[Event]:
        return self

    def __next__(self) -> Event:
        if self.over:
            raise StopIteration
        if not self._begun:
            self._begun = True
            self._thread.submit(self._pump())
        item = self._next()
        if isinstance(item, Event):
            return item
        self.over = True
        if item is not None:
            raise item
        raise StopIteration

    def _next(self) -> Event | BaseException | None:
        while True:
            with suppress(queue.Empty):
                return self._queue.get(timeout=HEED)

    def halt(self) -> None:
        """Start nothing more, and bring every robot to a safe waypoint; returns at once: go on iterating to the end."""
        self._thread.submit(self._run.halt())

    def stop(self) -> None:
        """Stop all motion now; returns at once: go on iterating to the end."""
        self._thread.submit(self._run.stop())
