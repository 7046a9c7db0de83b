"""A run that somebody attends: its events one by one, and in the end a report of the bench as it then is."""

from __future__ import annotations

import asyncio
import queue
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING

from pico.bench.running.loop import HEED, LoopThread
from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.contract import Edge
from pico.edge.protocol import Cut, Job
from pico.edge.running import new_run_id
from pico.model.plan import Plan
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport

if TYPE_CHECKING:
    from pico.twin.snapshot import Recording


class Execution:
    """A plan to be run: an iterator over its events, which begins with the first; `report` once it is `over`.

    An exception in the caller between two events does not end the run: go on iterating, or `halt` it first;
    `attending.attend` does.
    """

    def __init__(
        self,
        plan: Plan,
        edge: Edge,
        thread: LoopThread,
        named: Callable[[], str] | None = None,
        holder: str = "pico apply",
        *,
        recording: Recording | None = None,
        resumes: str | None = None,
        run_id: str | None = None,
        stop_on_error: bool = False,
        wait: float = 0.0,
        speed: float | None = None,
        within: str | None = None,
        follows: bool = False,
    ) -> None:
        """`thread`: where the edge lives. `named`: what the goal is called once the run is over. `recording`: gets what
        a film of it shows. `resumes`: the run that goes on under its id. `run_id`: of the new one.
        `stop_on_error`, `wait`, `speed`, `within`: see `pico.edge.protocol.Job`. `follows`: it was begun elsewhere
        under `run_id`, and goes on whoever looks on.
        """
        self.plan, self.id = plan, resumes or run_id or new_run_id()
        self._edge, self._thread, self._recording = edge, thread, recording
        self._named = named or (lambda: plan.target.name)
        self._job = Job(
            plan=plan, holder=holder, resumes=resumes is not None, stop_on_error=stop_on_error,
            filmed=recording is not None, wait=wait, speed=speed,
            within=within,
        )  # fmt: skip
        self._queue: queue.SimpleQueue[Event | RunReport | BaseException] = queue.SimpleQueue()
        self._report: RunReport | None = None
        self._asked = self._begun = self._cancelled = self.over = False
        self._follows = follows

    @property
    def report(self) -> RunReport:
        """What became of the run; raises RuntimeError before it is over."""
        if self._report is None:
            raise RuntimeError("the run is not over: iterate over it to the end")
        return self._report

    def __iter__(self) -> Iterator[Event]:
        return self

    def __next__(self) -> Event:
        """Return the next event; raises PicoError, before anything moves, where the plan must not be run."""
        if self.over:
            raise StopIteration
        self.begin()
        item = self._next()
        if isinstance(item, Event):
            return item
        self.over = True
        if isinstance(item, BaseException):
            raise item
        self._report = replace(item, goal=self._named()) if item.goal == self.plan.target.name else item
        raise StopIteration

    def begin(self) -> None:
        """Start it, and return at once; what it has to say is in `news`."""
        if not self._asked:
            self._asked = True
            self._thread.submit(self._pump())

    def leave(self) -> str:
        """Have the edge start it, and leave it to that; return its id. Raises PicoError, before anything moves, where
        the plan must not be run."""
        self._asked = self.over = True
        return self._thread.wait(self._edge.start(self._job, self.id))

    def news(self) -> list[Event]:
        """Return the events since the last time, without waiting; raises PicoError as iterating does."""
        found: list[Event] = []
        while not self.over and not self._queue.empty():
            found += [*islice(self, 1)]
        return found

    def _next(self) -> Event | RunReport | BaseException:
        while True:
            with suppress(queue.Empty):
                return self._queue.get(timeout=HEED)

    def halt(self) -> None:
        """Start nothing more, and bring every robot to a safe waypoint; returns at once: go on iterating to the end."""
        self._thread.submit(self._end(now=False))

    def stop(self) -> None:
        """Stop all motion now; returns at once: go on iterating to the end."""
        self._thread.submit(self._end(now=True))

    # in the loop of the edge

    async def _pump(self) -> None:
        try:
            self._queue.put(await self._followed())
        except asyncio.CancelledError:
            text = "the bench was closed before the run was over"
            self._queue.put(PicoError(error("interrupted", text), ExitCode.INTERRUPTED))
        except BaseException as exc:
            self._queue.put(exc)

    async def _followed(self) -> RunReport:
        """Start the run, hand on its events, and return what became of it."""
        if self._cancelled:
            raise PicoError(error("interrupted", "interrupted; nothing has moved"), ExitCode.INTERRUPTED)
        if not self._follows:
            await self._edge.start(self._job, self.id)
        self._begun, over = True, self._follows
        try:
            async for event in self._edge.events(self.id):
                over |= event.kind == "run_finished"
                self._queue.put(event)
        except Cut:
            over = True  # a line that is cut ends no run
            raise
        finally:
            if not over:
                await self._edge.cancel(self.id)
                with suppress(PicoError):
                    await self._edge.report(self.id)
        if self._recording is not None:
            self._recording.snapshots[:] = await self._edge.film(self.id)
        return await self._edge.report(self.id)

    async def _end(self, now: bool) -> None:
        self._cancelled = True
        at_once = now and self._begun  # who waits stops nobody else
        await (self._edge.stop() if at_once else self._edge.cancel(self.id))
