"""What is shown while a run goes on, and what Ctrl-C does to it."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from commanding import Pico
from pico_cli.runs.approving import question
from pico_cli.runs.running import execute
from pico_cli.session import Session

from pico.bench.bench import Bench
from pico.bench.moves import Moves
from pico.bench.plans import Plans
from pico.manifest.load import load_folder
from pico.model.operation import Operation, Reason
from pico.model.plan import Base, LabRef, Plan, Target
from pico.model.trace.event import Event
from pico.model.trace.report import RunReport
from pico.resources import labs_dir


def operation(number: int, component: str, **more: Any) -> Operation:
    places = {"from": {"slot": "storage/a1", "pose": {"x": 1, "y": 2}}, "to": {"pose": {"x": 395, "y": 420, "yaw": 0}}}
    return Operation(
        id=f"op{number}", primitive="move", component=component, robot="arm1", reason=Reason(kind="changed"),
        arguments=places, seconds=10.0, **more,
    )  # fmt: skip


PLAN = Plan(
    lab=LabRef(name="shel", digest=""), backend="sim", fidelity="physics", base=Base(), target=Target(revision="e1"),
    operations=(operation(1, "lx_125"), operation(2, "ly_150", after=("op1",))),
)  # fmt: skip


def event(kind: Any, number: int | None = None, **data: Any) -> Event:
    return Event(run="r", seq=1, kind=kind, time=0.0, operation=f"op{number}" if number else None, data=data)


class Interrupted:
    """A run in which Ctrl-C is pressed `presses` times after its first event."""

    def __init__(self, presses: int) -> None:
        self.presses, self.over, self.calls, self.plan = presses, False, list[str](), PLAN
        self.events = iter([event("operation_started", 1), event("operation_done", 1, seconds=9.8, error_mm=0.11),
                            event("operation_skipped", 2, interrupted=True)])  # fmt: skip
        self.seen = 0

    def __iter__(self) -> Iterator[Event]:
        return self

    def __next__(self) -> Event:
        if self.seen and self.presses:
            self.presses -= 1
            signal.raise_signal(signal.SIGINT)
            return event("operation_progress", 1, fraction=0.5)
        self.seen += 1
        try:
            return next(self.events)
        except StopIteration:
            self.over = True
            raise

    def halt(self) -> None:
        self.calls.append("halt")

    def stop(self) -> None:
        self.calls.append("stop")

    report = RunReport(run="r", goal="e1", outcome="interrupted", done=1, skipped=1, seconds=9.8, absent=("ly_150",))


class OneRun:
    def __init__(self, run: Any) -> None:
        self._run = run

    def run(self, plan: Plan, **_: Any) -> Any:
        return self._run


@pytest.mark.parametrize(("presses", "calls"), [(1, ["halt"]), (2, ["halt", "stop"])])
def test_ctrl_c_halts_then_stops_and_ends_with_a_tally(
    presses: int, calls: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    run, before = Interrupted(presses), signal.getsignal(signal.SIGINT)
    code = execute(Session(), OneRun(run), PLAN)  # type: ignore[arg-type]
    assert (code, run.calls) == (130, calls)
    assert signal.getsignal(signal.SIGINT) is before
    out = capsys.readouterr().out
    assert "✓ 1/2 lx_125 storage/a1 → (395, 420, 0°)" in out
    assert "off by 0.11 mm" in out
    assert "Interrupted: 1 of 2 operations done, 1 not started · 9.8 s simulated" in out


@pytest.mark.parametrize(("cause", "again"), [("undo", "pico resume"), ("checkout", "the same command")])
def test_after_an_undo_that_failed_the_same_command_would_undo_it(
    cause: Any, again: str, capsys: pytest.CaptureFixture[str]
) -> None:
    run = Interrupted(0)
    run.report = replace(run.report, outcome="failed")
    execute(Session(), OneRun(run), replace(PLAN, target=Target(revision="e1", cause=cause)))  # type: ignore[arg-type]
    assert f"Continue with {again}" in capsys.readouterr().out.replace("`", "")


@pytest.fixture
def hears_ctrl_c() -> Iterator[None]:
    """Let Ctrl-C count, though whatever started the tests may have had it ignored, as a shell does for `command &`."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("hears_ctrl_c")
def test_ctrl_c_while_it_plans_does_not_wait_for_the_plan(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    enough, planned = threading.Event(), threading.Event()

    def endless(self: Plans, *_: Any, **__: Any) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        enough.wait(60)
        planned.set()

    monkeypatch.setattr(Plans, "plan", endless)
    answer = pico("apply", "e1", "--auto-approve")
    assert (answer.code, planned.is_set()) == (130, False)
    assert "interrupted; nothing has moved" in answer.err
    enough.set()


@pytest.mark.usefixtures("hears_ctrl_c")
def test_ctrl_c_in_a_script_halts_the_run_before_the_script_hears_of_it(
    shel: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Interrupted(1)
    monkeypatch.setattr(Moves, "run", lambda *_: run)
    with Bench.open(shel) as bench, pytest.raises(KeyboardInterrupt):
        bench.apply(PLAN)
    assert run.calls == ["halt"]
    assert run.over


def test_a_failure_names_its_dependents(capsys: pytest.CaptureFixture[str]) -> None:
    run = Interrupted(0)
    dropped = {"severity": "error", "code": "dropped", "summary": "lx_125 slipped out of the fingers"}
    run.events = iter([event("operation_failed", 1, diagnostic=dropped), event("operation_skipped", 2, because="op1")])
    execute(Session(), OneRun(run), PLAN)  # type: ignore[arg-type]
    out = capsys.readouterr().out
    assert "✗ 1/2 lx_125 storage/a1 → (395, 420, 0°)  failed: lx_125 slipped out of the fingers" in out
    assert "- 2/2 ly_150 storage/a1 → (395, 420, 0°)  skipped: lx_125 did not get there" in out


def test_the_question_counts_right() -> None:
    from dataclasses import replace

    setup, _ = load_folder(labs_dir() / "shel").require()
    assert question(setup, PLAN) == "Run 2 moves on sim (physics)?"
    opens = replace(
        PLAN.operations[1], primitive="set", component="laser", arguments={"tunable": "shutter", "to": "open"}
    )
    plan = replace(PLAN, operations=(PLAN.operations[0], opens))
    assert question(setup, plan) == "Run 1 move, 1 setting on sim (physics) and let light out (laser.shutter)?"
    assert question(setup, replace(PLAN, operations=())) == ""
