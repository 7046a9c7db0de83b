"""The line that is overwritten while a plan is applied."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from pico_cli.views.run import Progress
from pico_cli.views.style import plain

from pico.model.event import Event
from pico.model.operation import Operation, Reason


def event(kind: Any, time: float, **data: Any) -> Event:
    return Event(run="r", seq=1, kind=kind, time=time, operation="op1", component="p1", data=data)


def test_it_names_the_operation_its_phase_and_the_time_simulated_so_far() -> None:
    move = Operation(
        id="op1",
        primitive="move",
        component="p1",
        robot="arm1",
        arguments={},
        reason=Reason(kind="asked"),
        seconds=10.0,
    )
    progress = Progress(SimpleNamespace(operations=[move], changes=[]))  # type: ignore[arg-type]
    progress.live(event("operation_started", 100.0))
    line = plain(progress.live(event("operation_progress", 143.2, fraction=0.5, phase="transit")))
    assert "1/1 p1" in line
    assert "5.0 / 10.0 s" in line
    assert line.endswith("transit   43 s in all")
