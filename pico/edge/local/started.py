"""The runs that were started at an edge since it was opened: what follows them asks for them by id."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, error

if TYPE_CHECKING:
    from pico.edge.running import Running
    from pico.model.trace.event import Event
    from pico.model.trace.report import RunReport
    from pico.twin.snapshot import Snapshot

KNOWN = 32
"""Runs whose events are kept in memory, for who follows them; the journal remembers all."""


class StartedRuns:
    """Runs by id, the oldest of those that are over forgotten. `cancelled`: ids of which nothing more may start, known
    here or not."""

    def __init__(self) -> None:
        self._runs: dict[str, Running] = {}
        self.cancelled: set[str] = set()

    def add(self, running: Running) -> None:
        """Add a run that starts."""
        over = [old for old, known in self._runs.items() if known.task is not None and known.task.done()]
        for old in over[: -KNOWN + 1]:
            del self._runs[old]
        self._runs[running.id] = running

    def knows(self, run: str) -> bool:
        """Return whether a run was started here."""
        return run in self._runs

    def is_known(self, run: str, plan: str) -> bool:
        """Return whether a run was started, of the plan with this digest; raises PicoError where of another one."""
        if run in self._runs and self._runs[run].plan != plan:
            raise PicoError(error("run", f"run {run} is of another plan", hint="start it under a new id"))
        return run in self._runs

    def __getitem__(self, run: str) -> Running:
        """Return a run; raises PicoError for one that was not started here."""
        if run not in self._runs:
            raise PicoError(
                error("no-run", f"no run {run} was started here", hint="`pico runs` lists those that are over")
            )
        return self._runs[run]

    def goes_on_with(self, run: str) -> bool:
        """Return whether a run that was started here is in progress."""
        task = self[run].task if self.knows(run) else None
        return task is not None and not task.done()

    async def events(self, run: str, since: int = 0) -> AsyncIterator[Event]:
        """Yield what happened in a run after its event `since`, and what happens."""
        async for event in self[run].events(since):
            yield event

    async def report(self, run: str) -> RunReport:
        """Wait for the end of a run, and return what became of it; raises PicoError for what cut it short."""
        task = self[run].task
        assert task is not None  # it is known from then on
        return await asyncio.shield(task)

    def film(self, run: str) -> list[Snapshot]:
        """Return what a film of a run shows; empty for one that was not filmed."""
        recording = self[run].recording
        return recording.snapshots if recording else []
