"""The walk: starts what may start, waits for what is under way, tells what happened."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from pico.backends.protocol import Backend, Lease
from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.execution.graph import Graph
from pico.journal import Journal, RunOutcome
from pico.model.event import Event, EventKind
from pico.model.operation import Operation, OperationResult
from pico.model.plan import Plan
from pico.model.record import as_json

PLACEMENTS = 3
"""How often a component is placed at most until it stands within tolerance: once, and twice again."""


class Walk:
    """One run of a plan. `events` gets what happens, then None."""

    def __init__(
        self,
        plan: Plan,
        backend: Backend,
        lease: Lease,
        *,
        run: str,
        now: float,
        cancelled: Callable[[], bool],
        journal: Journal | None = None,
    ) -> None:
        self.events: asyncio.Queue[Event | None] = asyncio.Queue()
        self._plan, self._backend, self._lease, self._run = plan, backend, lease, run
        self._graph = Graph(plan.operations)
        self._begun = self._now = now
        self._cancelled, self._journal = cancelled, journal
        self._interrupted = False
        self._seq = 0

    def interrupt(self) -> None:
        """Start nothing more; what is under way goes on to its safe end."""
        self._interrupted = True

    async def run(self) -> None:
        """Walk, then end the events, whatever happened."""
        try:
            await self.walk()
        finally:
            self.events.put_nowait(None)

    async def walk(self) -> None:
        """Walk the graph to its end, or to that of what is under way when it is interrupted.

        Raises PicoError where the run can't be journalled.
        """
        if self._journal:
            self._journal.begin_run(self._run, self._plan.digest, self._lease.holder)
        relay = asyncio.create_task(self._relay(self._backend.events()))
        try:
            self._emit("run_started", data={"plan": self._plan.digest, "operations": len(self._plan.operations)})
            await self._operations()
            await asyncio.sleep(0)  # what the backend said last is still on its way through the relay
        finally:
            relay.cancel()
            with suppress(asyncio.CancelledError):
                await relay
            self._finish()

    async def _operations(self) -> None:
        under_way: dict[asyncio.Task[OperationResult], Operation] = {}
        while True:
            for op in [] if self._stopping() else self._graph.ready():
                self._graph.start(op)
                under_way[asyncio.create_task(self._execute(op))] = op
            if not under_way:
                return
            over, _ = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for task in [t for t in under_way if t in over]:
                self._over(under_way.pop(task), task)

    def _stopping(self) -> bool:
        self._interrupted = self._interrupted or self._cancelled()
        return self._interrupted

    async def _execute(self, op: Operation) -> OperationResult:
        """Execute an operation; a part that was put down outside its tolerance is placed again."""
        attempt = 1
        while True:
            key = f"{self._run}/{op.id}/{attempt}"
            result = await self._backend.execute(op, key, self._lease)
            again = result.error is not None and result.error.code == "misplaced" and result.after is not None
            if not again or attempt == PLACEMENTS or self._stopping():
                return result
            op, attempt = _from_where_it_is(op, result), attempt + 1

    def _over(self, op: Operation, task: asyncio.Task[OperationResult]) -> None:
        try:
            result = task.result()
        except PicoError as exc:
            if exc.exit_code == ExitCode.INTERRUPTED:  # the backend was halted before this began
                self._interrupted = True
                self._graph.put_back(op)
                return
            self._interrupted = True  # a journal or a lease that is gone: nothing more can be done in order
            key = f"{self._run}/{op.id}/1"
            result = OperationResult(key=key, outcome="unknown", error=exc.diagnostics[0], ended=self._now)
        if result.error is not None and result.error.code == "stopped":
            self._interrupted = True
        self._now = max(self._now, result.ended)
        self._tell_end(op, result)
        for other in self._graph.finish(op, result.outcome):
            self._emit("operation_skipped", other, {"because": op.id})

    def _tell_end(self, op: Operation, result: OperationResult) -> None:
        if result.outcome == "done":
            self._emit("operation_done", op, {"seconds": result.seconds, **result.data})
            return
        kind: EventKind = "operation_failed" if result.outcome == "failed" else "operation_unknown"
        found = result.error or Diagnostic("error", "failed", f"{op.primitive} of {op.component} failed")
        self._emit(kind, op, {"seconds": result.seconds, "diagnostic": as_json(found)})

    def _finish(self) -> None:
        left = self._graph.waiting()
        stopped = self._interrupted and bool(left or self._graph.count("failed") or self._graph.count("unknown"))
        for op in left:
            self._emit("operation_skipped", op, {"interrupted": True})
        counts = {s: self._graph.count(s) for s in ("done", "failed", "unknown")}
        counts["skipped"] = self._graph.count("skipped") + len(left)
        missed = counts["failed"] + counts["unknown"]
        outcome: RunOutcome = "interrupted" if stopped else "failed" if missed else "done"
        tally = {**counts, "seconds": self._now - self._begun}
        if self._journal:
            self._journal.end_run(self._run, outcome, tally)
        self._emit("run_finished", data={"outcome": outcome, **tally})

    async def _relay(self, events: AsyncIterator[Event]) -> None:
        """Pass on what the backend says of the operations of this run."""
        async for event in events:
            if event.run == self._run:
                self._now = max(self._now, event.time)
                self._seq += 1
                self.events.put_nowait(replace(event, seq=self._seq))

    def _emit(self, kind: EventKind, op: Operation | None = None, data: Mapping[str, Any] | None = None) -> None:
        self._seq += 1
        who = {"operation": op.id, "component": op.component} if op else {}
        event = Event(run=self._run, seq=self._seq, kind=kind, time=self._now, data=data or {}, **who)
        self.events.put_nowait(event)


def _from_where_it_is(op: Operation, result: OperationResult) -> Operation:
    assert result.after is not None
    start = {"pose": as_json(result.after.pose)}
    return replace(op, arguments={**op.arguments, "from": start})
