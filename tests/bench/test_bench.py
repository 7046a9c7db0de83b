"""The bench as scripts and notebooks use it."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from attended import ended_when

import pico
from pico.bench.bench import Bench
from pico.diagnostics import ExitCode, PicoError
from pico.history.examples.example import make_example
from pico.model.plan import plan_from_json
from pico.model.pose import Pose


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bench") / "shel"
    make_example("shel", folder)
    return folder


@pytest.fixture
def bench(example: Path, tmp_path: Path) -> Bench:
    folder = tmp_path / "shel"
    shutil.copytree(example, folder)
    return pico.open(folder)


def test_a_script_plans_and_applies_a_revision(bench: Bench) -> None:
    plan = bench.plan("e1")
    assert {op.component for op in plan.operations if op.primitive == "move"} == {"p1", "p2", "lx_125", "ly_150"}
    report = bench.apply(plan)
    assert (report.outcome, report.remaining, report.exit_code) == ("done", (), ExitCode.DONE)
    assert report.evidence == "kinematic"
    assert bench.plan("e1").operations == ()


def test_the_same_question_has_the_same_plan(bench: Bench) -> None:
    assert bench.plan("e3").digest == bench.plan("e3").digest


def test_a_plan_says_where_it_starts_and_leads(bench: Bench) -> None:
    plan = bench.plan("e1")
    entry = bench.history.entry("e1")
    assert plan.target.commit == entry.commit.id
    assert plan.base.commit == bench.history.entry("HEAD").commit.id
    assert plan.target.state["lx_125"]["pose"] == {"x": 395, "y": 420, "yaw": 0}
    assert plan.base.state["lx_125"]["pose"] == {"x": 290, "y": 310, "yaw": 0}


def test_a_plan_survives_being_written_and_read(bench: Bench) -> None:
    plan = bench.plan("e1")
    again = plan_from_json(plan.to_json())
    assert again.digest == plan.digest
    assert bench.apply(again).outcome == "done"


def test_a_run_is_watched_event_by_event(bench: Bench) -> None:
    run = bench.run(bench.plan("e1"))
    kinds = [event.kind for event in run]
    assert (kinds[0], kinds[-1]) == ("run_started", "run_finished")
    assert kinds.count("operation_done") == run.report.done == len(run.plan.operations)
    assert run.over


def test_a_report_is_not_there_before_the_end(bench: Bench) -> None:
    run = bench.run(bench.plan("e1"))
    with pytest.raises(RuntimeError, match="not over"):
        _ = run.report
    list(run)


def test_a_halted_run_starts_nothing_more_and_the_next_plan_continues(bench: Bench) -> None:
    plan = bench.plan("e1")
    moved = ("lx_125", "ly_150", "p1", "p2")
    report = ended_when(bench, plan, lambda event: event.kind == "operation_done" and event.component in moved)
    assert report.outcome == "interrupted"
    assert report.skipped > 0
    assert 0 < report.done < len(plan.operations)
    rest = bench.plan("e1")
    assert 0 < len(rest.operations) < len(plan.operations)
    assert bench.apply(rest).exit_code == ExitCode.DONE


def test_a_stale_plan_is_refused_and_says_what_moved(bench: Bench) -> None:
    plan = bench.plan("e1")
    bench.sim.nudge("p2", dx=15)
    with pytest.raises(PicoError) as caught:
        bench.apply(plan)
    assert caught.value.exit_code == ExitCode.STALE
    assert "p2" in str(caught.value)


def test_an_impossible_plan_is_data_and_is_not_run(bench: Bench) -> None:
    bench.apply("C3")
    plan = bench.plans.single("p2", "move", {"x": "300"})
    assert plan.errored
    assert plan.operations == ()
    with pytest.raises(PicoError) as caught:
        bench.apply(plan)
    assert caught.value.exit_code == ExitCode.IMPOSSIBLE


def test_the_three_states_side_by_side(bench: Bench) -> None:
    bench.apply("C3")
    assert all(row.equal for row in bench.status().rows)
    assert bench.sim.nudge("p2", dx=5) == Pose(525, 420, 0)
    row = next(r for r in bench.status().rows if r.address == "p2")
    assert (row.committed, row.live) == ({"x": 520.0, "y": 420.0, "yaw": 0.0}, {"x": 525.0, "y": 420.0, "yaw": 0.0})
    assert (row.off, row.drifted, row.edited) == (True, True, False)


def test_history_reads_without_a_checkout(bench: Bench) -> None:
    assert bench.state_at("E1-1").components["lx_125"].pose == Pose(395, 420, 0)
    assert [c.component for c in bench.diff("E1-3", "E2-3")] == ["lx_100", "lx_125"]
    assert [e.commit.refs[0] for e in bench.log("e1")] == ["E1-3", "E1-2", "E1-1", "C3", "C2", "C1"]
    assert len(list(bench.log(every=True))) == 11


def test_the_state_comes_from_the_revision_and_the_bench_as_it_is_now(bench: Bench) -> None:
    lab = bench.root / "lab.yaml"
    lab.write_text(lab.read_text().replace("home: storage/b2", "home: storage/b4"))
    now = pico.open(bench.root)
    assert now.setup.lab.inventory["p2"].home == "storage/b4"
    moves = {op.component: op for op in now.plan("C2").operations}
    assert moves["p1"].arguments["to"]["pose"]["x"] == 290


def without_lens(bench: Bench) -> Bench:
    """Take lx_125 out of the inventory, as somebody who gave it away."""
    lab, table = bench.root / "lab.yaml", bench.root / "state" / "table.yaml"
    text = lab.read_text()
    lab.write_text(text[: text.index("  lx_125:")] + text[text.index("  ly_150:") :])
    table.write_text(table.read_text().replace("  lx_125:\n    slot: storage/a3\n", ""))
    return pico.open(bench.root)


def test_history_stays_readable_when_the_inventory_has_changed(bench: Bench) -> None:
    now = without_lens(bench)
    assert [c.component for c in now.diff("E1-3", "E2-3")] == ["lx_100", "lx_125"]
    assert not [e for e in now.log(every=True) if e.unreadable]
    assert next(r for r in now.status().rows if r.address == "p2").committed == {"x": 520.0, "y": 420.0, "yaw": 0.0}


def test_a_revision_that_needs_a_part_the_bench_has_not_any_more_is_refused(bench: Bench) -> None:
    with pytest.raises(PicoError) as caught:
        without_lens(bench).plan("e1")
    (found,) = (d for d in caught.value.diagnostics if d.severity == "error")
    assert "lx_125" in found.summary
    assert "when the bench had it" in found.hint
    assert found.source is not None and found.source.path == "e1:state/table.yaml"


def test_capture_writes_what_stands_on_the_bench(bench: Bench) -> None:
    bench.apply("C3")
    bench.sim.nudge("p2", dx=5)
    captured = bench.capture()
    assert [c.component for c in captured.changes] == ["p2"]
    assert bench.state.components["p2"].pose == Pose(525, 420, 0)
    assert bench.plan().operations == ()


def test_edits_below_tolerance_move_only_when_exact(bench: Bench) -> None:
    bench.apply("C3")
    table = bench.root / "state" / "table.yaml"
    table.write_text(table.read_text().replace("x: 520", "x: 520.3"))
    edited = pico.open(bench.root)
    plan = edited.plan()
    assert plan.operations == ()
    assert [c.component for c in plan.changes if c.tolerated] == ["p2"]
    assert [op.component for op in edited.plan(exact=True).operations if op.primitive == "move"] == ["p2"]


def test_a_folder_below_the_lab_opens_it_and_another_is_refused(bench: Bench, tmp_path: Path) -> None:
    assert pico.open(bench.root / "state").root == bench.root
    with pytest.raises(PicoError, match="no lab"):
        pico.open(tmp_path)


def test_a_slower_arm_takes_longer(bench: Bench) -> None:
    slow = Bench.open(bench.root, speed=0.1)
    assert slow.plan("e1").makespan > 1.5 * bench.plan("e1").makespan


def test_the_bench_closes_and_opens_again(bench: Bench) -> None:
    with bench:
        bench.apply("C2")
    assert bench.observe().components["p1"].pose == Pose(290, 420, 0)


def test_a_picture_of_the_bench_is_an_image(bench: Bench, tmp_path: Path) -> None:
    image = bench.pictures.render(size=(160, None), out=tmp_path / "bench.png")
    assert image.ndim == 3
    assert (tmp_path / "bench.png").read_bytes().startswith(b"\x89PNG")
