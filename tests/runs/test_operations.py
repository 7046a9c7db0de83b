"""The operations of a run, as its trace tells them."""

from __future__ import annotations

from typing import Any

from pico.model.trace.run import TraceEvent
from pico.runs.operations import operations


def event(kind: str, t: float, data: dict[str, Any], attempt: int = 1, operation: str = "op1") -> TraceEvent:
    return TraceEvent(t=t, seq=1, kind=kind, operation=operation, attempt=attempt, component="p1", data=data)


INTENT = {"primitive": "set", "arguments": {"tunable": "angle", "to": 5}, "seconds": 0.5, "reason": {"kind": "asked"}}


def test_each_attempt_has_its_start_its_seconds_and_its_end() -> None:
    failed, done = operations(
        [
            event("intent", 0, INTENT), event("started", 0, {}),
            event("failed", 2, {"seconds": 2.0, "error": {"summary": "no answer"}}),
            event("intent", 2, INTENT, 2), event("started", 2, {}, 2), event("done", 2.5, {"seconds": 0.5}, 2),
        ]
    )  # fmt: skip
    assert (failed.outcome, failed.seconds, failed.error) == ("failed", 2.0, {"summary": "no answer"})
    assert (done.attempt, done.start, done.seconds, done.planned, done.outcome) == (2, 2, 0.5, 0.5, "done")
    assert (done.address, done.reason) == ("p1.angle", "asked")


def test_what_was_only_meant_did_not_start_and_what_was_cut_short_is_unknown_until_somebody_says() -> None:
    meant, cut, said = operations(
        [
            event("intent", 0, INTENT, operation="c"),
            event("intent", 0, INTENT, operation="a"), event("started", 0, {}, operation="a"),
            event("intent", 0, INTENT, operation="b"), event("started", 1, {}, operation="b"),
            event("unknown", 1, {}, operation="b"),
            event("resolved", 1, {"outcome": "done", "by": "ann"}, operation="b"),
        ]
    )[::-1]  # fmt: skip
    assert (meant.outcome, meant.start) == ("not started", None)
    assert (cut.outcome, cut.settled, cut.id) == ("done", "ann", "b")
    assert (said.outcome, said.id) == ("unknown", "a")


def test_a_trace_of_another_program_is_read_as_far_as_it_goes() -> None:
    odd = [
        TraceEvent(t=0, seq=1, kind="started"),
        event("intent", 0, {"arguments": [1], "seconds": "soon", "reason": 3}),
        event("done", 1, {"seconds": True, "error": 4, "data": []}),
    ]
    (found,) = operations(odd)
    assert (found.component, found.outcome, found.seconds, found.planned, found.arguments) == (
        "p1",
        "done",
        None,
        None,
        {},
    )
