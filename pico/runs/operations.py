"""The operations of a run, read from its trace."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from typing import Any

from pico.model.operation import address_of
from pico.model.record import record
from pico.model.trace.run import TraceEvent

_ENDS = ("done", "failed", "unknown")


@record
class OperationRun:
    """One attempt at an operation.

    `start` on the bench's clock, `seconds` that it took; None where it did not begin, or nobody knows. `planned`: the
    seconds that the plan predicted. `outcome`: `done`, `failed`, `unknown`, or `not started`. `error`: the diagnostic
    of a failure. `data`: what it measured of itself, such as `error_mm` and `error_deg` of a placement. `settled`: who
    said how an unknown one ended. `run`: which of the runs that are folded into one it is of; `start` counts from that.
    """

    id: str
    attempt: int
    primitive: str
    component: str
    arguments: Mapping[str, Any] = field(default_factory=dict)
    reason: str = ""
    start: float | None = None
    seconds: float | None = None
    planned: float | None = None
    outcome: str = "not started"
    error: Mapping[str, Any] | None = None
    data: Mapping[str, Any] = field(default_factory=dict)
    settled: str = ""
    run: str = ""

    @property
    def address(self) -> str:
        """`p2`, or `p1.angle` where it is about one tunable or measurable."""
        return address_of(self.component, self.arguments)


def operations(trace: Iterable[TraceEvent]) -> tuple[OperationRun, ...]:
    """Return the operations of a trace in the order in which they were meant to begin; what is odd is passed over."""
    runs: dict[str, dict[tuple[str, int], dict[str, TraceEvent]]] = {}
    for event in trace:
        if event.operation is not None and event.attempt is not None:
            kept = runs.setdefault(event.run or "", {})
            kept.setdefault((event.operation, event.attempt), {})[event.kind] = event
    return tuple(op for run, kept in runs.items() for op in _of_run(run, kept))


def _of_run(run: str, kept: Mapping[tuple[str, int], Mapping[str, TraceEvent]]) -> list[OperationRun]:
    found = [replace(_one(*key, events), run=run) for key, events in kept.items()]
    return sorted(found, key=lambda op: (op.start is None, op.start or 0.0))


def _one(name: str, attempt: int, events: Mapping[str, TraceEvent]) -> OperationRun:
    meant: Mapping[str, Any] = events["intent"].data if "intent" in events else {}
    end = next((events[kind] for kind in _ENDS if kind in events), None)
    started, settled = events.get("started"), events.get("resolved")
    outcome = end.kind if end else "unknown" if started else "not started"
    reason = meant.get("reason")
    return OperationRun(
        id=name,
        attempt=attempt,
        primitive=str(meant.get("primitive", "")),
        component=next((e.component for e in events.values() if e.component), ""),
        arguments=_mapping(meant.get("arguments")),
        reason=str(reason.get("kind", "")) if isinstance(reason, Mapping) else "",
        start=started.t if started else None,
        seconds=_number(end.data.get("seconds")) if end and started else None,
        planned=_number(meant.get("nominal", meant.get("seconds"))),
        outcome=str(settled.data.get("outcome", outcome)) if settled else outcome,
        error=end.data.get("error") if end and isinstance(end.data.get("error"), Mapping) else None,
        data=_mapping(end.data.get("data")) if end else {},
        settled=str(settled.data.get("by", "")) if settled else "",
    )


def _mapping(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None
