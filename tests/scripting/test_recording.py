"""One run of all that a script does on a bench: taken once, checked each time, told truly however it ends."""

from __future__ import annotations

import shutil
import signal
import subprocess
from pathlib import Path

import forking
import pytest
from attended import ended_when
from serving import served

from pico.diagnostics import ExitCode, PicoError
from pico.recipes.encoding import encoded
from pico.runs.operations import operations
from pico.scripting.bench import Bench

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def bench(case_study: Path, tmp_path: Path) -> Bench:
    shutil.copytree(case_study, tmp_path / "shel")
    return Bench.open(tmp_path / "shel", fidelity="kinematic")


def turn(bench: Bench, angle: float) -> None:
    assert bench.apply(bench.single("p1", "set", angle=angle)).outcome == "done"


def runs(bench: Bench) -> list[tuple[str, str | None]]:
    memory = bench.edge.memory
    return [(run.run, run.outcome) for run in memory.runs()] if memory else []


def test_all_that_is_done_while_it_is_recorded_is_one_run(bench: Bench) -> None:
    with bench.record("scan") as run:
        for angle in (10, 20, 30):
            turn(bench, angle)
        bench.apply(bench.single("p1", "measure", measurable="angle"))
        bench.apply(bench.single("p1", "move", x=300, y=420, yaw=0))
        assert bench.apply("C3").reached
    assert runs(bench) == [(run.id, "done")]
    assert (run.report.goal, run.report.outcome, run.report.failed) == ("scan", "done", 0)
    assert [m.value for m in run.measurements] == [30.0]
    found, commit = bench.history.recorded_run()
    assert (found.document.id, found.document.goal, found.document.cause.kind, commit) == (
        run.id, "scan", "recording", None,
    )  # fmt: skip
    assert len(operations(found.trace)) == found.document.tally["done"] == run.report.done


def test_each_line_of_the_trace_has_the_state_before_and_after_it_and_who_did_it(bench: Bench) -> None:
    with bench.record("scan"):
        turn(bench, 10)
        bench.apply(bench.single("p1", "measure", measurable="angle"))
        turn(bench, 20)
    found, _ = bench.history.recorded_run()
    ends = [event for event in found.trace if event.kind == "done"]
    assert len(ends) == 3 and all(event.actor == found.document.operator for event in ends)
    first, looked, last = ends
    assert first.before == found.document.state_before and last.after == found.document.state_after
    assert first.before != first.after == looked.before == looked.after == last.before != last.after
    assert all(event.before is None for event in found.trace if event.kind in ("intent", "started"))


def test_steps_are_checked_as_single_operations_are(bench: Bench) -> None:
    with bench.record("checks"):
        old = bench.single("p1", "set", angle=10)
        turn(bench, 40)
        with pytest.raises(PicoError) as caught:
            bench.apply(old)
        assert caught.value.exit_code == ExitCode.STALE
        with pytest.raises(PicoError, match="takes no `turn`"):
            bench.single("p1", "set", turn=10)
        with pytest.raises(PicoError) as caught:
            bench.apply(bench.single("p1", "move", x=5000))
        assert caught.value.exit_code == ExitCode.IMPOSSIBLE
        turn(bench, 50)


def test_a_policy_denies_a_step(bench: Bench) -> None:
    lab = bench.root / "lab.yaml"
    rule = "    - {name: still, that: \"operations.all(o, o.component != 'p1')\", message: p1 stays}\n"
    lab.write_text(lab.read_text().replace("  rules:", f"  rules:\n{rule}#", 1))
    with Bench.open(bench.root, fidelity="kinematic") as strict, strict.record("denied"):
        plan = strict.single("p1", "set", angle=10)
        with pytest.raises(PicoError, match="p1 stays") as caught:
            strict.apply(plan)
        assert caught.value.exit_code == ExitCode.DENIED


def test_the_bench_is_taken_for_the_whole_of_it(bench: Bench) -> None:
    with bench.record("mine"):
        other = Bench.open(bench.root, fidelity="kinematic")
        with pytest.raises(PicoError, match=r"in use by .*: recording mine, 0 operations done") as caught:
            other.recovery.undo_plan()
        with pytest.raises(PicoError) as caught:
            other.apply(other.single("p2", "set", angle=3))
        assert caught.value.exit_code == ExitCode.LOCKED
        with pytest.raises(PicoError, match="a run has no run within it"):
            bench.record("within").__enter__()
    other.apply(other.single("p2", "set", angle=3))


def test_an_exception_ends_it_as_failed_and_ctrl_c_as_interrupted(bench: Bench) -> None:
    with pytest.raises(ZeroDivisionError), bench.record("bad"):
        turn(bench, 10)
        raise ZeroDivisionError
    with pytest.raises(KeyboardInterrupt), bench.record("stopped"):
        turn(bench, 20)
        raise KeyboardInterrupt
    assert [outcome for _, outcome in runs(bench)] == ["failed", "interrupted"]
    turn(bench, 30)


def test_ctrl_c_during_a_step_ends_the_run_where_it_stands(bench: Bench) -> None:
    with pytest.raises(PicoError) as caught, bench.record("stopped") as run:
        bench.apply(bench.single("p1", "set", angle=10))
        report = ended_when(bench, bench.single("p2", "move", x=560), lambda event: event.kind == "operation_started")
        assert report.outcome == "interrupted"
        bench.apply(bench.single("p1", "set", angle=20))
    assert caught.value.exit_code == ExitCode.INTERRUPTED
    assert run.report.outcome == "interrupted"
    assert bench.observe().known_values["p1"]["angle"] == 10.0


def test_what_is_asked_to_stop_from_elsewhere_stops(bench: Bench) -> None:
    from pico.bench.running.stopping import stop

    with pytest.raises(PicoError) as caught, bench.record("stopped"):
        turn(bench, 10)
        holder, last = stop(bench.place)
        assert holder is not None and holder.what == "recording stopped"
        assert last is not None and last.outcome == "interrupted"
        turn(bench, 20)
    assert caught.value.exit_code == ExitCode.INTERRUPTED


def test_what_needs_a_run_that_is_over_waits_for_its_end(bench: Bench) -> None:
    with bench.record("scan") as run:
        turn(bench, 10)
        with pytest.raises(PicoError, match="still being recorded"):
            bench.commit("Too early", "capture")
        with pytest.raises(PicoError, match="time passes only by what it does"):
            bench.pause(5)
    bench.pause(5)
    assert run.id in bench.commit("In time", "capture").runs


def test_a_bench_behind_a_socket_is_recorded_as_well(bench: Bench) -> None:
    with served(bench.root), Bench.open(bench.root) as remote:
        with remote.record("scan") as run:
            for angle in (10, 20):
                remote["p1"].angle = angle
                remote.measure("p1.angle")
        assert (run.report.outcome, run.report.done) == ("done", 4)
        assert [m.value for m in run.measurements] == [10.0, 20.0] and run.table["p1.angle"] == [10.0, 20.0]
        with pytest.raises(KeyboardInterrupt), remote.record("stopped"):
            remote["p1"].angle = 30
            raise KeyboardInterrupt
        assert [outcome for _, outcome in runs(remote)] == ["done", "interrupted"]


def test_undo_takes_back_a_whole_recorded_run(bench: Bench) -> None:
    before = bench.observe().known_values
    with bench.record("scan"):
        for angle in (10, 20):
            turn(bench, angle)
        bench.apply(bench.single("p2", "set", angle=5))
    bench.apply(bench.recovery.undo_plan())
    assert bench.observe().known_values == before


def test_a_commit_carries_it_as_one_run(bench: Bench) -> None:
    with bench.record("scan") as run:
        for angle in (10, 20):
            turn(bench, angle)
    assert bench.commit("Scanned", "capture").runs == (run.id,)
    found, commit = bench.history.recorded_run(run.id)
    assert commit is not None and [e.after for e in found.trace if e.kind == "done"][-1] is not None


def test_a_run_in_which_nothing_was_done_says_so(bench: Bench) -> None:
    with bench.record("empty") as run:
        assert run._repr_html_().startswith("<div>")
        with pytest.raises(PicoError, match="nothing was done in the run empty yet"):
            _ = run.table
    assert (run.report.outcome, run.report.done) == ("done", 0)


def test_a_commit_has_all_lines_of_a_scan(bench: Bench) -> None:
    with bench.record("scan") as run:
        for n in range(60):
            turn(bench, 10 + n)
    assert bench.commit("Scanned", "capture").runs == (run.id,)
    found, _ = bench.history.recorded_run(run.id)
    assert not found.document.artifacts and len([e for e in found.trace if e.kind == "done"]) == 60


SCRIPT = """
import signal, sys, pico
signal.signal(signal.SIGINT, signal.default_int_handler)
with pico.open(sys.argv[1], fidelity="kinematic") as bench, bench.record("scan") as run:
    for angle in range(1000):
        bench.apply(bench.single("cam", "measure", measurable="centroid"))
        print(run.id, flush=True)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_killed_script_leaves_a_run_that_is_told_truly(bench: Bench, how: signal.Signals) -> None:
    with forking.started(SCRIPT, str(bench.root), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as script:
        assert script.stdout is not None
        run = [script.stdout.readline().strip() for _ in range(2)][-1]
        script.send_signal(how)
    told = None if how == signal.SIGKILL else "interrupted"
    assert runs(bench) == [(run, told)]
    found, _ = bench.history.recorded_run()
    assert found.document.outcome == (told or "killed") and found.document.tally["done"] >= 2
    with pytest.raises(PicoError, match="its script alone can go on"):
        bench.recovery.resume_plan()
    bench.apply(bench.recovery.recover_plan())
    turn(bench, 10)


@pytest.mark.parametrize("what", ["measure", "move"])
def test_what_was_set_in_passing_is_set_back_after_it_was_cut_short(bench: Bench, what: str) -> None:
    bench.apply("e1")
    before = bench.measurements.read("laser", "shutter")
    with pytest.raises(PicoError), bench.record("cut"):
        plan = bench.single("cam", "measure", measurable="dark")
        plan = bench.single("p2", "move", x=560) if what == "move" else plan
        ended_when(bench, plan, lambda event: event.data.get("value") == "closed")
        turn(bench, 20)
    assert bench.measurements.read("laser", "shutter") != before
    plan = bench.recovery.recover_plan()
    assert "laser.shutter as before" in plan.target.name
    bench.apply(plan)
    assert bench.measurements.read("laser", "shutter") == before
    assert not bench.recovery.recover_plan().operations


def test_a_recorded_loop_becomes_a_recipe_with_all_its_steps(bench: Bench) -> None:
    with bench.record("mini"):
        for angle in (20, 40, 60):
            bench["p2"].angle = angle
            bench.measure("p2.angle")
        for x in (520, 540):
            bench["p1"].move(x=x, y=420, yaw=0)
    steps = [line for line in encoded("mini", "shel", [bench.history.recorded_run()[0]]).split("\n") if "  - " in line]
    assert steps == [
        "  - set: {p2.angle: 20.0}", "  - measure: p2.angle", "  - set: {p2.angle: 40.0}", "  - measure: p2.angle",
        "  - set: {p2.angle: 60.0}", "  - measure: p2.angle",
        "  - move: {p1: {x: 520.0, y: 420.0, yaw: 0.0}}", "  - move: {p1: {x: 540.0, y: 420.0, yaw: 0.0}}",
    ]  # fmt: skip
