"""Lasers whose arming is over are shut, by whoever has the bench, as operations that the journal has; so is what an
unattended run left open."""

from __future__ import annotations

import asyncio
from typing import Protocol

from pico.backends.device import Capabilities
from pico.diagnostics import Diagnostic, error
from pico.edge import emission
from pico.edge.about import about_run
from pico.edge.armings import forget
from pico.edge.protocol import Holder, Lease
from pico.edge.running import new_run_id
from pico.edge.unattended import Alone, Held
from pico.model.observation import Observation
from pico.model.operation import Operation, OperationResult
from pico.model.setup import Setup
from pico.places.bench import BenchPlace
from pico.runs.journal import Journal


class Emitting(Protocol):
    """What shutting needs of an edge that has its bench."""

    @property
    def setup(self) -> Setup: ...

    @property
    def place(self) -> BenchPlace: ...

    @property
    def journal(self) -> Journal: ...

    @property
    def alone(self) -> Alone:
        """What holds an unattended run to its terms."""
        ...

    async def observe(self) -> Observation: ...

    async def describe(self) -> Capabilities: ...

    def now(self) -> str:
        """Return the wall time as ISO 8601, UTC."""
        ...

    def run_under_way(self) -> str | None:
        """Return the run that an operation belongs to now, None where none goes on."""
        ...

    async def perform(self, operation: Operation, key: str) -> OperationResult:
        """Have an operation done; cancelling the wait does not cancel it."""
        ...


class ActingEdge(Emitting, Held, Protocol):
    """The whole edge, for what acts on its bench as a client does: it shuts a laser, or ends a run."""

    @property
    def lease(self) -> Lease | None:
        """The lease of who has the bench through this edge."""
        ...

    async def holder(self) -> Holder | None: ...


class Shutting:
    """Shuts the lasers of one bench, one after the other."""

    def __init__(self, edge: Emitting) -> None:
        self._edge, self._one_at_a_time = edge, asyncio.Lock()
        self._told: tuple[Diagnostic, ...] = ()

    async def shut_over(self, seen: Observation | None) -> None:
        """Shut the lasers whose arming is over, and of what is `seen` those that shine without one. One that can't be
        shut keeps no other one open; whoever has the bench next tries it again. Who takes the bench also brings about
        the end state of an unattended run that is due."""
        edge = self._edge
        async with self._one_at_a_time:
            bare = emission.unlicensed(edge.setup, seen) if seen is not None else {}
            for laser, why in (bare | emission.over(edge.setup, edge.place, edge.now())).items():
                await self._shut(laser, why)
            if seen is not None and edge.alone.due():
                await self._end()

    async def _end(self) -> None:
        """Shut lasers and put out lamps as an unattended run states that ends now, or whose process was killed."""
        edge, done = self._edge, list[Operation]()
        for operation in edge.alone.tidies(edge.setup, await edge.observe()):
            if await self._done(operation):
                done.append(operation)
                self._told = (*self._told, edge.alone.told(operation))
        edge.alone.tidied(tuple(done))

    async def shut(self, names: tuple[str, ...], why: str) -> tuple[Diagnostic, ...]:
        """Shut lasers, whatever arms them; return of which that could not be done."""
        edge, wrong = self._edge, list[Diagnostic]()
        async with self._one_at_a_time:
            for laser in names:
                operation = emission.shutting(edge.setup, await edge.observe(), laser, why)
                if operation is not None and not await self._done(operation):
                    wrong.append(error("lapsed", f"{laser} may emit still", address=laser))
        return tuple(wrong)

    def told(self) -> tuple[Diagnostic, ...]:
        """Return, once, which lasers were shut, and why."""
        told, self._told = self._told, ()
        return told

    async def _shut(self, laser: str, why: str) -> None:
        edge = self._edge
        operation = emission.shutting(edge.setup, await edge.observe(), laser, why)
        if operation is not None:
            if not await self._done(operation):
                return
            self._told = (*self._told, emission.told(laser, why))
        forget(edge.place, laser)

    async def _done(self, operation: Operation) -> bool:
        """Have an operation done, in the run under way or in one of its own; return whether it was."""
        edge = self._edge
        under_way = edge.run_under_way()
        run = under_way or await self._tidying(operation)
        result = await edge.perform(operation, f"{run}/{operation.id}.{edge.now()}/1")
        if under_way is None:
            edge.journal.end_run(run, "done" if result.outcome == "done" else "failed", {result.outcome: 1})
        return result.outcome == "done"

    async def _tidying(self, operation: Operation) -> str:
        """Begin a run of one operation that tidies up, and return its id."""
        edge = self._edge
        able = await edge.describe()
        plan = emission.shut_plan(edge.setup, await edge.observe(), operation, able)
        run = new_run_id()
        about = about_run(edge.setup, plan, able)
        edge.journal.begin_run(run, plan.digest, "the edge", document=plan.to_json(), about=about)
        return run
