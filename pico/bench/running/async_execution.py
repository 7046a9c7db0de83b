"""A run that somebody attends: its events one by one, and in the end a report of the bench as it then is."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import AsyncGenerator, Callable
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from pico.diagnostics import ExitCode, PicoError, error
from pico.edge.protocol import Edge, Job
from pico.model.event import Event
from pico.model.plan import Plan
from pico.model.report import RunReport

if TYPE_CHECKING:
    from pico.twin.snapshot import Recording


class AsyncExecution:
    """A plan under way: iterate over it for its events, then read its `report`.

    Who stops iterating ends the run at a safe waypoint. Cancelled while it iterates, it does too, and at once the
    second time; the events come to their end, and then the cancellation goes on.
    """

    def __init__(
        self,
        plan: Plan,
        edge: Edge,
        named: Callable[[], str] | None = None,
        holder: str = "pico apply",
        *,
        recording: Recording | None = None,
        resumes: str | None = None,
        stop_on_error: bool = False,
        wait: float = 0.0,
    ) -> None:
        """`named`: what the goal is called once the run is over. `recording`: gets what a film of it shows. `resumes`:
        the run that goes on under its id. `stop_on_error`, `wait`: see `pico.edge.protocol.Job`.
        """
        self.plan, self.id = plan, resumes or new_run_id()
        self._edge, self._recording, self._named = edge, recording, named or (lambda: plan.target.name)
        self._job = Job(
            plan=plan, holder=holder, resumes=resumes is not None, stop_on_error=stop_on_error,
            filmed=recording is not None, wait=wait,
        )  # fmt: skip
        self._report: RunReport | None = None
        self._cancelled = self._begun = False

    @property
    def report(self) -> RunReport:
        """What became of the run; raises RuntimeError before it is over."""
        if self._report is None:
            raise RuntimeError("the run is not over: iterate over it to the end")
        return self._report

    async def halt(self) -> None:
        """Start nothing more, and bring every robot to a safe waypoint; the events then come to their end."""
        self._cancelled = True
        await self._edge.cancel(self.id)

    async def stop(self) -> None:
        """Stop all motion now; the events then come to their end."""
        self._cancelled = True
        await (self._edge.stop() if self._begun else self._edge.cancel(self.id))  # who waits stops nobody else

    async def __aiter__(self) -> AsyncGenerator[Event, None]:
        """Yield the events; raises PicoError, before anything moves, where the plan must not be run."""
        if self._cancelled:
            raise PicoError(error("interrupted", "interrupted; nothing has moved"), ExitCode.INTERRUPTED)
        await self._edge.start(self._job, self.id)
        self._begun, over = True, False
        try:
            async for event in self._attended():
                over = event.kind == "run_finished"
                yield event
        finally:
            if not over:
                await self._edge.cancel(self.id)
                with suppress(PicoError):
                    await self._edge.report(self.id)
        if self._recording is not None:
            self._recording.snapshots[:] = await self._edge.film(self.id)
        report = await self._edge.report(self.id)
        self._report = replace(report, goal=self._named()) if report.goal == self.plan.target.name else report

    async def _attended(self) -> AsyncGenerator[Event, None]:
        """Yield the events, and end the run in order where the task that waits for them is cancelled."""
        seen, ending = 0, list[asyncio.Task[None]]()
        while True:
            try:
                async for event in self._edge.events(self.id, seen):
                    seen = event.seq
                    yield event
                break
            except asyncio.CancelledError:
                end = self._edge.stop() if ending else self._edge.cancel(self.id)
                ending.append(asyncio.create_task(end))
        if ending:
            await asyncio.wait(ending)
            await self._edge.report(self.id)
            raise asyncio.CancelledError


def new_run_id() -> str:
    """Return the id of a run: the time in UTC, and six random characters."""
    return f"{datetime.now(UTC):%Y%m%dT%H%M%SZ}-{secrets.token_hex(3)}"
