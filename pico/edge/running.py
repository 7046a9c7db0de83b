"""A run under way at an edge: its log of events, which outlives who listens, and its report."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import AsyncIterator
from dataclasses import dataclass, field

from pico.base import clock
from pico.execution.walk import Walk
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport
from pico.twin.snapshot import Recording


@dataclass
class Running:
    """One run. `report` once it is over, unless something cut it short: then that is what `task` raises."""

    id: str
    plan: str
    recording: Recording | None = None
    log: list[Event] = field(default_factory=list)
    walk: Walk | None = None
    task: asyncio.Task[RunReport] | None = None
    _news: asyncio.Event = field(default_factory=asyncio.Event)

    def tell(self, event: Event) -> None:
        """Add an event to the log, and wake who listens."""
        self.log.append(event)
        self._news.set()
        self._news = asyncio.Event()

    def over(self, _: object) -> None:
        """Wake who listens, for nothing more comes."""
        self._news.set()

    async def events(self, since: int) -> AsyncIterator[Event]:
        """Yield the events with higher numbers than `since`, up to the last one."""
        at = since
        while True:
            news = self._news
            while at < len(self.log):
                yield self.log[at]
                at += 1
            if (self.log and self.log[-1].kind == "run_finished") or self.task is None or self.task.done():
                return
            await news.wait()


def new_run_id() -> str:
    """Return the id of a run: the time in UTC, and six random characters."""
    return f"{clock.stamp()}-{secrets.token_hex(3)}"
