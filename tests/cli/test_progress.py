"""The line that is overwritten while a plan is applied."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from pico_cli.views.run import Progress
from pico_cli.views.style import paint, plain

from pico.model.operation import Operation, Reason
from pico.model.trace.event import Event


def event(kind: Any, time: float, operation: str = "op1", **data: Any) -> Event:
    return Event(run="r", seq=1, kind=kind, time=time, operation=operation, component="p1", data=data)


def asked(operation: str) -> Operation:
    return Operation(
        id=operation,
        primitive="move",
        component="p1",
        robot="arm1",
        arguments={},
        reason=Reason(kind="asked"),
        seconds=10.0,
    )


def test_it_names_the_operation_its_phase_and_the_time_simulated_so_far() -> None:
    progress = Progress(SimpleNamespace(operations=[asked("op1")], changes=[]))  # type: ignore[arg-type]
    progress.live(event("operation_started", 100.0))
    line = plain(progress.live(event("operation_progress", 143.2, fraction=0.5, phase="transit")))
    assert "1/1 p1" in line
    assert "43.2 of about 10.0 s" in line
    assert line.endswith("transit   43 s in all")


def test_an_operation_stands_beside_what_was_foretold_and_is_marked_once_it_is_late() -> None:
    progress = Progress(SimpleNamespace(operations=[asked("op1")], changes=[]))  # type: ignore[arg-type]
    progress.live(event("operation_started", 100.0))
    late = paint("yellow", " 17.1 of about 10.0 s")
    assert late not in progress.live(event("operation_progress", 117.0)) and late != plain(late)
    assert late in progress.live(event("operation_progress", 117.1))
    assert "of about" not in plain(progress.line(event("operation_done", 117.0, seconds=17.0)))
    assert "17.1 s of about 10.0 s" in plain(progress.line(event("operation_done", 117.1, seconds=17.1)))


def test_the_count_rises_line_by_line_though_operations_run_beside_one_another() -> None:
    progress = Progress(SimpleNamespace(operations=[asked(n) for n in ("op1", "op2", "op3")], changes=[]))  # type: ignore[arg-type]
    assert "1/3" in plain(progress.live(event("operation_started", 0.0, "op1")))
    assert "1/3" in plain(progress.live(event("operation_started", 0.0, "op2")))
    ended = [
        ("operation_done", "op3"),
        ("operation_retried", "op1"),
        ("operation_done", "op2"),
        ("operation_failed", "op1"),
    ]
    lines = [plain(progress.line(event(kind, 1.0, name))) for kind, name in ended]  # type: ignore[arg-type]
    assert [line.split()[1] for line in lines] == ["1/3", "2/3", "2/3", "3/3"]
