"""What became of a run, read from its events."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Any, Literal

from pico.diagnostics import ExitCode
from pico.model.event import Event
from pico.model.record import record

OperationEnd = Literal["done", "failed", "unknown", "skipped"]
_ENDS: Mapping[str, OperationEnd] = {
    "operation_done": "done",
    "operation_failed": "failed",
    "operation_unknown": "unknown",
    "operation_skipped": "skipped",
}


@record
class OperationReport:
    """How one operation ended; `data` as in its last event."""

    outcome: OperationEnd
    component: str
    data: Mapping[str, Any] = field(default_factory=dict)


@record
class RunResult:
    """How a run ended: counts of operations, `seconds` on the backend's clock, each operation by id in the order in
    which they ended."""

    run: str
    outcome: Literal["done", "failed", "interrupted"]
    done: int = 0
    failed: int = 0
    unknown: int = 0
    skipped: int = 0
    seconds: float = 0.0
    operations: Mapping[str, OperationReport] = field(default_factory=dict)

    @classmethod
    def of(cls, events: Iterable[Event]) -> RunResult:
        """Return the result that the events of one run amount to; raises ValueError where it is not finished."""
        operations: dict[str, OperationReport] = {}
        for event in events:
            if event.kind in _ENDS and event.operation:
                end = OperationReport(outcome=_ENDS[event.kind], component=event.component or "", data=event.data)
                operations[event.operation] = end
            elif event.kind == "run_finished":
                return cls(run=event.run, operations=operations, **event.data)
        raise ValueError("the run is not finished")

    @property
    def exit_code(self) -> ExitCode:
        """What a command ends with."""
        codes = {"done": ExitCode.DONE, "failed": ExitCode.ERROR, "interrupted": ExitCode.INTERRUPTED}
        return codes[self.outcome]
