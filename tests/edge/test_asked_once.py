"""What an edge said of runs that are done is not asked again: a plan looks through many for when light was sought."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pico.edge.link.client import RemoteEdge
from pico.runs.journal import RunRecord

GOING = RunRecord(run="r2", plan="p", holder="ann", started_at="2026-01-01T00:00:00Z")
DONE = replace(GOING, run="r1", finished_at="2026-01-01T00:01:00Z", outcome="done")
CUT = replace(DONE, run="r3", outcome="interrupted")


class Line:
    def __init__(self) -> None:
        self.runs, self.asked = (DONE, GOING, CUT), list[str]()

    def call(self, name: str, *arguments: Any) -> Any:
        if name == "memory.records":
            self.asked.append(arguments[0])
        return {"memory": True, "memory.runs": self.runs, "memory.records": (f"of {arguments[:1]}",)}[name]


def test_records_of_a_run_that_is_done_are_asked_for_once_and_of_others_each_time() -> None:
    line = Line()
    edge = RemoteEdge(line)  # type: ignore[arg-type]

    def told() -> list[Any]:
        memory = edge.memory
        assert memory is not None
        return [memory.records(run=run.run) for run in memory.runs()]

    assert told() == told() and line.asked == ["r1", "r2", "r3", "r2", "r3"]
    line.runs = (DONE, replace(GOING, outcome="done"), CUT)
    line.asked.clear()
    assert told() == told() and line.asked == ["r2", "r3", "r3"]
