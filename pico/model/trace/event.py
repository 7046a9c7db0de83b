"""What happens while a plan is executed, as a stream of `pico.event/v1`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any, Literal

from pico.model.record import record

EventKind = Literal[
    "run_started", "operation_started", "operation_progress", "operation_done", "operation_failed",
    "operation_unknown", "operation_skipped", "operation_retried", "run_finished",
]  # fmt: skip


@record
class Event:
    """One event. `time` is the backend's clock [s]; `data` depends on the kind:

    `operation_started`: `primitive`, `seconds` that its plan foretells; `operation_progress`: `phase`, `fraction` (0 to
    1), `pose` of the carried part; `operation_done`: `error_mm`, `error_deg` of a placement, `measurement`,
    `seconds`; `operation_failed` and `operation_unknown`: `diagnostic`;
    `operation_retried`: `attempt` that follows, `diagnostic` of the one that failed; `operation_skipped`: `because` (an
    operation's id), or `interrupted`, or `stopped` (after an error); `run_finished`: `done`,
    `failed`, `skipped`, `seconds`.
    """

    schema: str = "pico.event/v1"
    run: str
    seq: int
    kind: EventKind
    time: float
    operation: str | None = None
    component: str | None = None
    data: Mapping[str, Any] = field(default_factory=dict)
