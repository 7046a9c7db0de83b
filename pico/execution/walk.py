"""The walk: starts what may start, waits for what is under way, tells what happened."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

from pico.backends.protocol import Backend, Lease
from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.execution.executor import Dispatch, Executor
from pico.model.event import Event, EventKind
from pico.model.operation import Operation, OperationResult
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.model.run import tally
from pico.runs.journal import Journal, RunOutcome


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
        stop_on_error: bool = False,
        resumed: bool = False,
        about: Mapping[str, Any] | None = None,
    ) -> None:
        self.events: asyncio.Queue[Event | None] = asyncio.Queue()
        self._plan, self._backend, self._lease, self._run = plan, backend, lease, run
        self._executor = Executor(plan.operations, run, stop_on_error)
        self._begun = self._now = now
        self._cancelled, self._journal, self._resumed, self._about = cancelled, journal, resumed, about
        self._seq = 0

    def interrupt(self) -> None:
        """Start nothing more; what is under way goes on to its safe end."""
        self._executor.interrupt()

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
        if self._journal and not self._resumed:
            document = self._plan.to_json()
            holder = self._lease.holder
            self._journal.begin_run(self._run, self._plan.digest, holder, document=document, about=self._about)
        elif self._journal:
            self._journal.resume_run(self._run, self._about)
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
        under_way: dict[asyncio.Task[OperationResult], Dispatch] = {}
        while True:
            for dispatch in self._due():
                under_way[self._start(dispatch)] = dispatch
            if not under_way:
                return
            over, _ = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for task in [t for t in under_way if t in over]:
                again = self._over(under_way.pop(task), task)
                if again is not None:
                    under_way[self._start(again)] = again

    def _due(self) -> list[Dispatch]:
        if self._cancelled():
            self._executor.interrupt()
        return self._executor.due()

    def _start(self, dispatch: Dispatch) -> asyncio.Task[OperationResult]:
        return asyncio.create_task(self._execute(dispatch))

    async def _execute(self, dispatch: Dispatch) -> OperationResult:
        return await self._backend.execute(dispatch.operation, dispatch.key, self._lease)

    def _over(self, dispatch: Dispatch, task: asyncio.Task[OperationResult]) -> Dispatch | None:
        """Tell how an attempt ended; return the one that follows, if any."""
        op = dispatch.operation
        try:
            result = task.result()
        except PicoError as exc:
            if exc.exit_code == ExitCode.INTERRUPTED:  # the backend was halted before this began
                self._executor.refused(dispatch)
                return None
            self._executor.interrupt()  # a journal or a lease that is gone: nothing more can be done in order
            result = OperationResult(key=dispatch.key, outcome="unknown", error=exc.diagnostics[0], ended=self._now)
        self._now = max(self._now, result.ended)
        if self._cancelled():
            self._executor.interrupt()
        after = self._executor.over(dispatch, result)
        if after.again is not None:
            self._emit("operation_retried", op, {"attempt": after.again.attempt, **_failure(op, result)})
            return after.again
        self._tell_end(op, result)
        for other in after.skipped:
            self._emit("operation_skipped", other, {"because": op.id})
        return None

    def _tell_end(self, op: Operation, result: OperationResult) -> None:
        if result.outcome == "done":
            self._emit("operation_done", op, {"seconds": result.seconds, **result.data})
            return
        kind: EventKind = "operation_failed" if result.outcome == "failed" else "operation_unknown"
        self._emit(kind, op, {"seconds": result.seconds, **_failure(op, result)})

    def _finish(self) -> None:
        graph = self._executor.graph
        left, counts = graph.waiting(), tally(graph.status.values())
        for op in left:
            self._emit("operation_skipped", op, {"stopped" if self._executor.broken else "interrupted": True})
        missed = counts["failed"] + counts["unknown"]
        stopped = self._executor.interrupted and (left or missed)
        outcome: RunOutcome = "interrupted" if stopped else "failed" if missed else "done"
        data = {**counts, "seconds": self._now - self._begun}
        try:
            if self._journal:
                self._journal.end_run(self._run, outcome, data)
        finally:  # a journal that is gone must not hide what became of the run
            self._emit("run_finished", data={"outcome": outcome, **data})

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


def _failure(op: Operation, result: OperationResult) -> dict[str, Any]:
    found = result.error or Diagnostic("error", "failed", f"{op.primitive} of {op.component} failed")
    return {"diagnostic": as_json(found)}
