"""A run as its client follows it: ended in order, whoever reads it, and the loop of its edge free meanwhile."""

from __future__ import annotations

import ast
import asyncio
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from benches import plan_to, shel, sim

import pico
from pico.bench.plans import Plans
from pico.bench.running.attending import attend
from pico.bench.running.execution import Execution
from pico.bench.running.loop import LoopThread
from pico.diagnostics import ExitCode, PicoError
from pico.edge.local import LocalEdge
from pico.history.examples.example import make_example
from pico.model.plan import Plan
from pico.model.trace.event import Event

SETUP, C3 = shel("gantry")


class Overheard:
    """An edge whose events are overheard in its own loop, before any reader in another thread has them."""

    def __init__(self, edge: LocalEdge, hear: Callable[[Event], None]) -> None:
        self.edge, self.hear = edge, hear

    def __getattr__(self, name: str) -> Any:
        return getattr(self.edge, name)

    async def events(self, run: str, since: int = 0) -> AsyncIterator[Event]:
        async for event in self.edge.events(run, since):
            self.hear(event)
            yield event


@pytest.fixture
def edge(tmp_path: Path) -> LocalEdge:
    return sim(SETUP, tmp_path)


@pytest.fixture
def thread(edge: LocalEdge) -> Iterator[LoopThread]:
    thread = LoopThread()
    yield thread
    thread.wait(edge.close())
    thread.close()


@pytest.fixture
def planned(edge: LocalEdge) -> Plan:
    return asyncio.run(plan_to(edge, C3))


def ended(edge: LocalEdge, thread: LoopThread, plan: Plan, when: Callable[[Event], bool], *how: str) -> Execution:
    """Return a run that is ended, in these ways one after the other, when an event comes for the first time."""
    ways = list(how)

    def hear(event: Event) -> None:
        while when(event) and ways:
            getattr(run, ways.pop(0))()

    run = Execution(plan, Overheard(edge, hear), thread)
    return run


def test_who_halts_a_run_still_hears_its_end(edge: LocalEdge, thread: LoopThread, planned: Plan) -> None:
    run = ended(edge, thread, planned, lambda event: event.kind == "operation_started", "halt")
    events = list(run)
    assert events[-1].kind == "run_finished" and events[-1].data["outcome"] == run.report.outcome == "interrupted"
    assert not run.report.held and not edge.journal.unsettled()
    assert thread.wait(edge.holder()) is None


def test_halted_and_then_stopped_it_stops_at_once_and_the_gripper_holds(
    edge: LocalEdge, thread: LoopThread, planned: Plan
) -> None:
    run = ended(edge, thread, planned, lambda event: event.data.get("phase") == "transit", "halt", "stop")
    failed = [event for event in run if event.kind == "operation_failed"]
    assert run.report.outcome == "interrupted"
    assert {event.data["diagnostic"]["code"] for event in failed} == {"stopped"}
    carried = next(op.component for op in planned.operations if op.primitive == "move")
    assert thread.wait(edge.observe()).robots["arm1"].holding == carried


def test_a_reader_that_fails_ends_the_run_safely_and_gives_the_bench_back(
    edge: LocalEdge, thread: LoopThread, planned: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    halted, halt = threading.Event(), Execution.halt

    def halts(run: Execution) -> None:
        halt(run)
        halted.set()

    def fails(event: Event) -> None:
        if event.kind == "operation_progress":
            raise ZeroDivisionError

    monkeypatch.setattr(Execution, "halt", halts)

    heard: list[Event] = []

    def waits(event: Event) -> None:
        heard.extend([event] if event.kind == "operation_progress" else ())
        if len(heard) > 1:  # the reader has the first one by then, and fails
            assert halted.wait(60)

    run = Execution(planned, Overheard(edge, waits), thread)
    with pytest.raises(ZeroDivisionError):
        attend(run, fails)
    assert run.over and run.report.outcome == edge.journal.runs()[0].outcome == "interrupted"
    assert not edge.journal.unsettled() and thread.wait(edge.holder()) is None
    again = Execution(thread.wait(plan_to(edge, C3)), edge, thread)
    assert [event.kind for event in again][-1] == "run_finished" and again.report.outcome == "done"


def test_what_is_halted_before_it_begins_moves_nothing(edge: LocalEdge, thread: LoopThread, planned: Plan) -> None:
    run = Execution(planned, edge, thread)
    run.halt()
    with pytest.raises(PicoError, match="nothing has moved") as caught:
        next(run)
    assert caught.value.exit_code == ExitCode.INTERRUPTED and run.over and not list(run)
    assert edge.memory is None


def test_what_is_remembered_is_read_while_the_run_writes_it(edge: LocalEdge, thread: LoopThread, planned: Plan) -> None:
    known = []
    for event in Execution(planned, edge, thread):
        if event.kind == "operation_done":
            assert edge.memory is not None
            known.append(len(edge.memory.records()))
    assert known == sorted(known) and known[-1] == 3 * len(planned.operations)


# nothing that computes runs on the loop


def test_while_a_bench_plans_the_loop_of_its_edge_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    planning, answered = threading.Event(), threading.Event()

    def busy(*_: Any, **__: Any) -> None:
        planning.set()
        assert answered.wait(60), "the loop does not answer"
        raise PicoError([])

    make_example("shel", tmp_path / "shel")
    monkeypatch.setattr("pico.planning.planner.Planner.plan", busy)
    with pico.open(tmp_path / "shel") as bench:

        def asks() -> None:
            planning.wait(60)
            assert bench.wait(bench.edge.describe()).name == "sim"
            answered.set()

        asking = threading.Thread(target=asks)
        asking.start()
        with pytest.raises(PicoError):
            Plans(bench).plan("e1")
        asking.join()
    assert answered.is_set()


def test_only_what_drives_an_edge_or_asks_instruments_themselves_is_asynchronous_in_the_services() -> None:
    root = Path(pico.__file__).parent / "bench"
    found = {
        str(path.relative_to(root))
        for path in root.rglob("*.py")
        if any(isinstance(node, ast.AsyncFunctionDef | ast.Await) for node in ast.walk(ast.parse(path.read_text())))
    }
    asks_instruments = {f"commissioning/{name}.py" for name in ("pulling", "reaching", "swinging", "trying")}
    asks_instruments |= {f"calibrating/{name}.py" for name in ("arms", "axes", "dark", "hands")}
    assert found == {"running/execution.py", "running/loop.py"} | asks_instruments
