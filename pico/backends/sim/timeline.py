"""Simulated time: it passes only here, for all operations in progress at once, as fast as the machine can."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Collection, Generator
from typing import Any, Generic, TypeVar

from pico.backends.sim.steering.pace import TICK, Pace

T = TypeVar("T")

REACTION_TURNS = 16
"""Turns of the event loop between the end of an operation and the next moment of simulated time. Who waits for the
end hears of it, and starts what may follow, in four; what starts in them starts at the same moment."""


class Timeline(Generic[T]):
    """Steps operations in progress: generators that yield the seconds until they want to be resumed.

    `advance` lets time pass for all of them. Who is due at the same moment is resumed in the order of the ids.
    """

    def __init__(self, now: float, advance: Callable[[float], None]) -> None:
        self.now = now
        self._advance = advance
        self._works: dict[str, Generator[float, None, T]] = {}
        self._due: dict[str, float] = {}
        self._futures: dict[str, asyncio.Future[T]] = {}
        self._task: asyncio.Task[None] | None = None
        self._news = False
        self.look: Callable[[], None] | None = None  # called whenever time has passed
        self.pace: Pace | None = None  # with which it passes; None: as fast as the machine can

    @property
    def under_way(self) -> Collection[str]:
        """The ids of the operations in progress."""
        return self._works.keys()

    def start(self, id: str, work: Generator[float, None, T]) -> asyncio.Future[T]:
        """Begin `work` now, and return the future of its result."""
        self._works[id], self._due[id] = work, self.now
        future = self._futures[id] = asyncio.get_running_loop().create_future()
        self._news = True
        if self._task is None or self._task.done():
            self._task = asyncio.create_task(self._run())
        return future

    def interrupt(self, exc: Exception) -> None:
        """Raise `exc` in every operation in progress, at the moment that it is now."""
        for id in sorted(self._works, key=natural):
            self._resume(id, exc)

    async def idle(self) -> None:
        """Wait until no operation is in progress."""
        while self._task is not None and not self._task.done():
            await asyncio.wait([self._task])

    async def _run(self) -> None:
        while self._works:
            while self._news:
                self._news = False
                for _ in range(REACTION_TURNS):
                    await asyncio.sleep(0)
            if self._works:
                left = self.pace.left(min(self._due.values())) if self.pace else 0.0
                if left > 0:
                    await asyncio.sleep(min(left, TICK))
                    continue
                self._step()
            await asyncio.sleep(0)

    def _step(self) -> None:
        """Go to the next moment at which an operation is due, and resume those that are."""
        moment = max(self.now, min(self._due.values()))
        if moment > self.now:
            try:
                self._advance(moment - self.now)
            except Exception as exc:  # a world that can't go on fails everything in it, instead of hanging
                self.interrupt(exc)
                return
            self.now = moment
        for id in sorted((i for i, due in self._due.items() if due <= self.now), key=natural):
            self._resume(id)
        if self.look is not None:
            self.look()

    def _resume(self, id: str, exc: Exception | None = None) -> None:
        work = self._works[id]
        try:
            wait = work.throw(exc) if exc else next(work)
            self._due[id] = self.now + max(0.0, wait)
        except StopIteration as stop:
            self._end(id).set_result(stop.value)
        except Exception as failure:
            self._end(id).set_exception(failure)

    def _end(self, id: str) -> asyncio.Future[Any]:
        self._news = True
        del self._works[id], self._due[id]
        return self._futures.pop(id)


def natural(id: str) -> tuple[tuple[int, str], ...]:
    """Return a sort key by which `op2` comes before `op10`."""
    return tuple((int(word), "") if word.isdigit() else (-1, word) for word in re.split(r"(\d+)", id))
