"""Taking a run up again, and taking it back, as scripts do it."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from attended import ended_when

from pico.bench.bench import Bench
from pico.diagnostics import PicoError
from pico.history.examples.example import make_example
from pico.model.plan import plan_from_json
from pico.model.pose import Pose
from pico.model.trace.event import Event
from pico.runs.journal import Journal


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
    report = ended_when(bench, bench.plan(goal), lambda e: e.kind == "operation_done" and "error_mm" in e.data)
    assert report.outcome == "interrupted"
    return report.run


def test_a_resumed_run_keeps_its_id_repeats_nothing_and_reaches_the_goal(bench: Bench) -> None:
    id = cut_short(bench, "e1")
    plan, run = bench.recovery.resume_plan()
    assert run == id
    assert {op.id.split(".")[0] for op in plan.operations} == {"r1"}
    report = _run(bench, plan, run)
    assert (report.outcome, report.run) == ("done", id)
    assert bench.plan("e1").operations == ()
    with pytest.raises(PicoError, match="nothing to resume"):
        bench.recovery.resume_plan()


def _run(bench: Bench, plan, run):  # type: ignore[no-untyped-def]
    going = bench.run(plan, resumes=run)
    list(going)
    return going.report


def test_a_resumed_single_operation_moves_only_what_was_asked(bench: Bench) -> None:
    bench.apply("C3")
    move = bench.plans.single("p2", "move", {"x": "600"})
    ended_when(bench, move, lambda event: event.data.get("phase") == "approach")  # before the part is gripped
    bench.sim.nudge("p1", dx=4)
    plan, _ = bench.recovery.resume_plan()
    assert {op.component for op in plan.operations if op.primitive == "move"} == {"p2"}


def test_a_resumed_measurement_sets_back_what_was_set_for_it(bench: Bench) -> None:
    bench.apply("e1")
    before = bench.measurements.read("laser", "shutter")
    plan = bench.plans.single("cam", "measure", {"measurable": "dark"})
    ended_when(bench, plan, lambda event: event.data.get("value") == "closed")
    assert bench.measurements.read("laser", "shutter") != before
    resumed, run = bench.recovery.resume_plan()
    assert [(op.primitive, op.component) for op in resumed.operations] == [("set", "laser")]
    assert [d.hint for d in resumed.diagnostics if d.code == "left-out"] == ["`pico measure cam.dark` does it anew"]
    assert _run(bench, resumed, run).outcome == "done"
    assert bench.measurements.read("laser", "shutter") == before


def test_a_search_for_an_exposure_is_not_taken_up_again_and_that_is_said(bench: Bench) -> None:
    bench.apply("e1")
    plan = bench.plans.single("cam", "auto_range", {"tunable": "exposure"})
    ended_when(bench, plan, lambda event: event.kind == "operation_started", at_once=True)
    with pytest.raises(PicoError, match="did not come to its end") as refused:
        bench.recovery.resume_plan()
    assert refused.value.diagnostics[0].hint == "`pico do cam auto_range exposure` does it anew"


def test_a_resumed_move_opens_the_shutter_again_that_was_shut_for_it(bench: Bench) -> None:
    bench.apply("e1")
    before = bench.measurements.read("laser", "shutter")
    ended_when(bench, bench.plans.single("p2", "move", {"x": "560"}), lambda event: event.data.get("value") == "closed")
    assert bench.measurements.read("laser", "shutter") != before
    assert _run(bench, *bench.recovery.resume_plan()).outcome == "done"
    assert bench.measurements.read("laser", "shutter") == before


def test_after_hands_were_emptied_it_is_said_what_goes_on_with_the_run_that_was_cut_short(bench: Bench) -> None:
    id = cut_short(bench, "e1")
    emptied = bench.run(bench.recovery.recover_plan())
    list(emptied)
    assert emptied.report.outcome == "done"
    with pytest.raises(PicoError, match="nothing to resume") as refused:
        bench.recovery.resume_plan()
    assert (refused.value.diagnostics[0].hint or "").startswith("`pico apply e1` goes on with ")
    assert id in str(refused.value.diagnostics[0].hint)


def test_what_goes_on_from_a_run_keeps_its_fidelity_unless_another_is_asked_for(bench: Bench) -> None:
    with Bench.open(bench.root, fidelity="physics") as physical:
        assert physical.apply(physical.plans.single("p1", "set", {"angle": "33"})).outcome == "done"
    with Bench.open(bench.root) as next_one:
        assert next_one.plan().fidelity == "kinematic"
        assert next_one.recovery.undo_plan().fidelity == "physics"
        assert next_one.recovery.recover_plan().fidelity == "physics"
    with Bench.open(bench.root, fidelity="kinematic") as asked:
        assert asked.recovery.undo_plan().fidelity == "kinematic"


def test_undo_takes_back_what_the_run_moved_and_nothing_else(bench: Bench) -> None:
    bench.apply("C3")
    bench.apply("e1")
    bench.sim.nudge("hwp", dx=3)
    plan = bench.recovery.undo_plan()
    assert plan.target.name.startswith("the state before run")
    assert bench.apply(plan).outcome == "done"
    seen = bench.observe().components
    assert seen["lx_125"].pose == Pose(290, 310, 0)
    assert seen["p2"].pose == Pose(520, 420, 0)
    assert seen["hwp"].pose == Pose(225, 420, 0)
    again = bench.recovery.undo_plan()
    assert bench.apply(again).outcome == "done"
    assert bench.observe().components["lx_125"].pose == Pose(395, 420, 0)


def test_undo_goes_back_to_before_the_run_and_not_to_before_hands_were_emptied_after_it(bench: Bench) -> None:
    before = {name: part.pose for name, part in bench.observe().components.items()}
    placed = set[str]()

    def with_a_second_part_in_hand(event: Event) -> bool:
        if event.kind == "operation_done" and "error_mm" in event.data:
            placed.add(event.component)
        return bool(placed) and event.data.get("phase") == "transit"

    cut = ended_when(bench, bench.plan("e1"), with_a_second_part_in_hand, at_once=True)
    assert cut.outcome == "interrupted" and cut.held
    assert bench.apply(bench.recovery.recover_plan()).outcome == "done"
    plan = bench.recovery.undo_plan()
    assert plan.target.of == cut.run
    assert bench.apply(plan).outcome == "done"
    seen = bench.observe().components
    assert placed and {name: seen[name].pose for name in placed} == {name: before[name] for name in placed}


def put(bench: Bench, part: str, pose: Pose) -> Pose:
    """Put a part somewhere by hand."""
    now = bench.observe().components[part].pose
    assert now is not None
    bench.sim.nudge(part, dx=pose.x - now.x, dy=pose.y - now.y, dyaw=pose.yaw - now.yaw)
    return pose


def test_a_part_off_the_center_of_a_slot_comes_back_exactly(bench: Bench) -> None:
    stood = put(bench, "p2", Pose(206.4, 213.6, 45))
    bench.apply("C3")
    assert bench.apply(bench.recovery.undo_plan()).outcome == "done"
    assert bench.observe().components["p2"].pose == stood


def test_a_part_that_stands_elsewhere_in_its_slot_is_not_called_equal(bench: Bench) -> None:
    put(bench, "p2", Pose(206.4, 213.6, 45))
    bench.apply(bench.plans.single("p2", "move", {"x": "201", "y": "219", "yaw": "0"}))
    plan = bench.recovery.undo_plan()
    assert not plan.reached
    assert [op.component for op in plan.operations if op.primitive == "move"] == ["p2"]


def test_what_else_was_changed_since_is_left_and_named(bench: Bench) -> None:
    bench.apply("C3")
    bench.apply(bench.plans.single("p1", "set", {"angle": "7"}))
    put(bench, "p1", Pose(640, 420, 0))
    report = bench.apply(bench.recovery.undo_plan())
    assert (report.whole, report.scope, report.left) == (False, "only p1.angle", ("p1.pose",))
    assert bench.observe().components["p1"].pose == Pose(640, 420, 0)


def test_a_journal_that_keeps_names_of_slots_is_undone_into_them(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    bench.apply("C3")
    kept = Journal.document

    def older(journal: Journal, run: str) -> str:
        plan = plan_from_json(kept(journal, run) or "")
        state = {**plan.base.state, "p2": {"slot": "storage/b2"}}
        return replace(plan, base=replace(plan.base, state=state)).sealed().to_json()

    monkeypatch.setattr(Journal, "document", older)
    assert bench.apply(bench.recovery.undo_plan()).reached
    assert bench.observe().components["p2"].pose == Pose(200, 220, 0)


def test_a_bench_whose_lock_file_was_deleted_goes_on(bench: Bench) -> None:
    bench.apply("e1")
    bench.apply("C3")
    (bench.root / ".pico/benches/sim" / "lock").unlink()
    assert bench.apply("e1").outcome == "done"
    assert bench.apply("C3").outcome == "done"
