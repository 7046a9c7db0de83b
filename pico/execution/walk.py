"""The walk: starts what may start, waits for what is under way, tells what happened."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import replace
from typing import Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError
from pico.execution.executor import Dispatch, Executor
from pico.model.commissioning import ONE_MOTION
from pico.model.operation import Operation, OperationResult
from pico.model.plan import Plan
from pico.model.record import as_json
from pico.model.trace.event import Event, EventKind
from pico.model.trace.run import RunOutcome, tally

Execute = Callable[[Operation, str], Awaitable[OperationResult]]
"""Has an operation executed under a key; raises PicoError, with exit code INTERRUPTED where nothing more is begun."""


class Walk:
    """One run of a plan, from the time `now` on [s]. `tell` hears what happens, `run_finished` last."""

    def __init__(
        self,
        plan: Plan,
        execute: Execute,
        tell: Callable[[Event], None],
        *,
        run: str,
        now: float,
        stop_on_error: bool = False,
    ) -> None:
        self._plan, self._execute, self._tell, self._run = plan, execute, tell, run
        self._executor = Executor(plan.operations, run, stop_on_error)
        self._begun = self._now = now
        self._seq = 0
        self._one_motion = False  # an arm has made the one motion that it makes a command

    def interrupt(self) -> None:
        """Start nothing more but to set back; what is under way goes on to its safe end."""
        self._executor.interrupt()

    def sets_back(self, operation: Operation) -> bool:
        """Whether an operation sets back what was set only to measure."""
        return operation.id in self._executor.graph.backs

    def heard(self, event: Event) -> None:
        """Pass on what the device says of the operations of this run."""
        if event.run == self._run:
            self._now = max(self._now, event.time)
            self._pass_on(event)

    async def walk(self) -> None:
        """Walk the graph to its end, or to that of what is under way when it is interrupted."""
        try:
            self._emit("run_started", data={"plan": self._plan.digest, "operations": len(self._plan.operations)})
            await self._operations()
        finally:
            self._finish()

    async def _operations(self) -> None:
        under_way: dict[asyncio.Task[OperationResult], Dispatch] = {}
        while True:
            for dispatch in self._executor.due():
                under_way[self._start(dispatch)] = dispatch
            if not under_way:
                return
            over, _ = await asyncio.wait(under_way, return_when=asyncio.FIRST_COMPLETED)
            for task in [t for t in under_way if t in over]:
                again = self._over(under_way.pop(task), task)
                if again is not None:
                    under_way[self._start(again)] = again

    def _start(self, dispatch: Dispatch) -> asyncio.Task[OperationResult]:
        return asyncio.create_task(self._attempt(dispatch))

    async def _attempt(self, dispatch: Dispatch) -> OperationResult:
        return await self._execute(dispatch.operation, dispatch.key)

    def _over(self, dispatch: Dispatch, task: asyncio.Task[OperationResult]) -> Dispatch | None:
        """Tell how an attempt ended; return the one that follows, if any."""
        op = dispatch.operation
        try:
            result = task.result()
        except PicoError as exc:
            if exc.exit_code == ExitCode.INTERRUPTED:  # the bench was halted before this began
                self._one_motion = self._one_motion or exc.diagnostics[0].code == ONE_MOTION
                self._executor.refused(dispatch)
                return None
            self._executor.give_up()  # a journal or a lease that is gone: nothing more can be done in order
            result = OperationResult(key=dispatch.key, outcome="unknown", error=exc.diagnostics[0], ended=self._now)
        self._now = max(self._now, result.ended)
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
            why = "one_motion" if self._one_motion else "stopped" if self._executor.broken else "interrupted"
            self._emit("operation_skipped", op, {why: True})
        missed = counts["failed"] + counts["unknown"]
        stopped = self._executor.interrupted and (left or missed)
        outcome: RunOutcome = "interrupted" if stopped else "failed" if missed else "done"
        data = {**counts, "seconds": self._now - self._begun}
        self._emit("run_finished", data={"outcome": outcome, **data})

    def _emit(self, kind: EventKind, op: Operation | None = None, data: Mapping[str, Any] | None = None) -> None:
        who = {"operation": op.id, "component": op.component} if op else {}
        self._pass_on(Event(run=self._run, seq=0, kind=kind, time=self._now, data=data or {}, **who))

    def _pass_on(self, event: Event) -> None:
        self._seq += 1
        self._tell(replace(event, seq=self._seq))


def _failure(op: Operation, result: OperationResult) -> dict[str, Any]:
    found = result.error or Diagnostic("error", "failed", f"{op.primitive} of {op.component} failed")
    return {"diagnostic": as_json(found)}
