"""How a run ended, read from its events: each operation by itself, which the report does not say."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from pico.model.trace.event import Event

_ENDS = {f"operation_{end}": end for end in ("done", "failed", "unknown", "skipped")}


@dataclass(frozen=True)
class End:
    """How one operation ended; `data` as in its last event."""

    outcome: str
    component: str
    data: Mapping[str, Any]


@dataclass(frozen=True)
class RunResult:
    """Counts of operations, `seconds` on the backend's clock, each operation by id in the order in which they ended."""

    outcome: str
    done: int
    failed: int
    unknown: int
    skipped: int
    seconds: float
    operations: Mapping[str, End]

    @classmethod
    def of(cls, events: Iterable[Event]) -> RunResult:
        """Return the result that the events of one run amount to; raises ValueError where it is not finished."""
        operations = {}
        for event in events:
            if event.kind in _ENDS and event.operation:
                operations[event.operation] = End(_ENDS[event.kind], event.component or "", event.data)
            elif event.kind == "run_finished":
                return cls(operations=operations, **event.data)
        raise ValueError("the run is not finished")
