"""Taking a run up again, and taking it back, as scripts do it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from pico.bench import Bench
from pico.diagnostics import PicoError
from pico.history.example import make_example
from pico.model.pose import Pose


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("takeup") / "shel"
    make_example("shel", folder)
    return folder


@pytest.fixture
def bench(example: Path, tmp_path: Path) -> Bench:
    folder = tmp_path / "shel"
    shutil.copytree(example, folder)
    return Bench.open(folder)


def cut_short(bench: Bench, goal: str) -> str:
    run = bench.run(bench.plan(goal))
    for event in run:
        if event.kind == "operation_done" and "error_mm" in event.data:
            run.halt()
    assert run.report.outcome == "interrupted"
    return run.report.run


def test_a_resumed_run_keeps_its_id_repeats_nothing_and_reaches_the_goal(bench: Bench) -> None:
    id = cut_short(bench, "e1")
    plan, run = bench.resume_plan()
    assert run == id
    assert {op.id.split(".")[0] for op in plan.operations} == {"r1"}
    report = _run(bench, plan, run)
    assert (report.outcome, report.run) == ("done", id)
    assert bench.plan("e1").operations == ()
    with pytest.raises(PicoError, match="nothing to resume"):
        bench.resume_plan()


def _run(bench: Bench, plan, run):  # type: ignore[no-untyped-def]
    going = bench.run(plan, resumes=run)
    list(going)
    return going.report


def test_a_resumed_single_operation_moves_only_what_was_asked(bench: Bench) -> None:
    bench.apply("C3")
    run = bench.run(bench.single("p2", "move", {"x": "600"}))
    for event in run:
        if event.data.get("phase") == "approach":
            run.halt()
    bench.sim.nudge("p1", dx=4)
    plan, _ = bench.resume_plan()
    assert {op.component for op in plan.operations if op.primitive == "move"} == {"p2"}


def test_undo_takes_back_what_the_run_moved_and_nothing_else(bench: Bench) -> None:
    bench.apply("C3")
    bench.apply("e1")
    bench.sim.nudge("hwp", dx=3)
    plan = bench.undo_plan()
    assert plan.target.name.startswith("the bench before")
    assert bench.apply(plan).outcome == "done"
    seen = bench.observe().components
    assert seen["lx_125"].pose == Pose(290, 310, 0)
    assert seen["p2"].pose == Pose(520, 420, 0)
    assert seen["hwp"].pose == Pose(225, 420, 0)
    again = bench.undo_plan()
    assert bench.apply(again).outcome == "done"
    assert bench.observe().components["lx_125"].pose == Pose(395, 420, 0)
