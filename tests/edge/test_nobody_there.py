"""The edge itself holds a run where nobody is there: when its client is killed, and when its own process is."""

from __future__ import annotations

import os
import shutil
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bench_at import bench_at
from serving import served

from pico.bench.bench import Bench
from pico.bench.cut_short import told_first
from pico.bench.mending.files import damaged_files
from pico.diagnostics import ExitCode, PicoError
from pico.edge import terms_store, unattended
from pico.edge.protocol import RECIPE, Job
from pico.history.examples.example import make_example
from pico.model.observation import live_state
from pico.model.plan import Target
from pico.model.trace.unattended import Left, Terms
from pico.planning import PlanGoal

NAME = "night@20261124T230000Z-abcdef"


def terms(**other: Any) -> Terms:
    return Terms(**{"recipe": NAME, "laser_class": "3R", "until": "2099-01-01T00:00:00Z", "every": 600.0, **other})


@pytest.fixture(scope="session")
def lit(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A lab whose laser emits."""
    root = make_example("shel", tmp_path_factory.mktemp("unattended") / "shel").root
    with Bench.open(root) as bench:
        bench.apply()
    return root


@pytest.fixture
def lab(lit: Path, tmp_path: Path) -> Path:
    shutil.copytree(lit, tmp_path / "shel")
    return tmp_path / "shel"


def emits(bench: Bench) -> bool:
    return any(row.emits for row in bench.lasers.rows())


def killed(work: Callable[[], None]) -> None:
    """Do some work in a process that is then killed."""
    child = os.fork()
    if child == 0:
        try:
            work()
        finally:
            os.kill(os.getpid(), signal.SIGKILL)
    assert os.WIFSIGNALED(os.waitpid(child, 0)[1])


def open_run(bench: Bench) -> None:
    """Hold a run to its terms, and begin it as a recipe does."""
    bench.wait(bench.edge.hold(terms()))
    seen = bench.observe()
    target = Target(title="night", cause="recipe", recipe=NAME)
    plan = bench.plans.planner(seen).plan(PlanGoal(live_state(bench.setup, seen), target, operations=()))
    bench.wait(bench.edge.open(Job(plan=plan, holder=f"{RECIPE} {NAME}"), "night"))


def begun(lab: Path) -> Callable[[], None]:
    def work() -> None:
        open_run(Bench.open(lab))

    return work


def left_of(bench: Bench) -> Left:
    while (found := bench.wait(bench.edge.unattended())) is None or found.left is None:
        pass
    return found.left


def test_a_client_that_is_killed_leaves_the_bench_as_it_stated_by_the_edge_that_serves_it(lab: Path) -> None:
    with served(lab), Bench.open(lab) as bench:
        assert emits(bench)
        killed(begun(lab))
        left = left_of(bench)
        assert (left.why, left.reached, left.wrong) == (unattended.GONE, ("shut", "lamps off", "parked"), ())
        assert not emits(bench) and left.was["laser.shutter"] == "open"
        assert bench.wait(bench.edge.holder()) is None
        runs = bench.edge.memory.runs()  # type: ignore[union-attr]
        assert next(r.outcome for r in runs if r.run == "night") == "interrupted"
        assert "night ended: its client is gone" in told_first(bench, bench.observe())[0].summary


def test_a_process_of_its_own_that_is_killed_is_told_of_and_whatever_takes_the_bench_next_shuts_it(lab: Path) -> None:
    killed(begun(lab))
    with Bench.open(lab) as bench:
        first, why, *_ = told_first(bench, bench.observe())
        assert "night ended: its process was killed" in first.summary and "not left shut" in why.summary
        assert emits(bench)  # looking changes nothing
        (said,) = bench.recovery.settle()
        assert not emits(bench) and "left shut, lamps off" in said.detail
        again = left_of(bench)
        assert again.reached == ("shut", "lamps off") and again.was["laser.shutter"] == "open"
        assert bench.wait(bench.edge.hold(terms())) == again  # taken up: it may open what its end had shut


@pytest.mark.parametrize("lost", [("unattended.json",), ("unattended.json", "unattended.lock")])
def test_one_whose_terms_were_deleted_after_it_was_killed_is_known_from_its_lock_or_the_journal(
    lab: Path, lost: tuple[str, ...]
) -> None:
    killed(begun(lab))
    for name in lost:
        (bench_at(lab).folder / name).unlink()
    (said,) = (one for one in damaged_files(lab, Path) if one.code == "unattended")
    assert str(bench_at(lab).folder / "unattended.json") in said.summary and "`pico recover`" in said.hint
    with Bench.open(lab) as bench:
        first, why, *_ = told_first(bench, bench.observe())
        assert "night ended: its process was killed" in first.summary and "not left shut" in why.summary
        (said,) = bench.recovery.settle()
        assert not emits(bench) and "left shut, lamps off" in said.detail
        assert left_of(bench).reached == ("shut", "lamps off")
    assert not [one for one in damaged_files(lab, Path) if one.code == "unattended"]


def test_a_run_that_was_left_as_it_states_leaves_no_terms_behind(lab: Path) -> None:
    with Bench.open(lab) as bench:
        open_run(bench)
        assert "night" in (bench_at(lab).folder / "unattended.lock").read_text()
        bench.wait(bench.edge.leave(NAME, True))
        assert bench.wait(bench.edge.unattended()) is None and terms_store.read(bench_at(lab)) is None
    assert (bench_at(lab).folder / "unattended.lock").read_bytes() == b""


def test_damaged_terms_in_the_lock_count_as_a_killed_run_that_shuts_everything(lab: Path) -> None:
    killed(begun(lab))
    (bench_at(lab).folder / "unattended.json").unlink()
    lock = bench_at(lab).folder / "unattended.lock"
    lock.write_bytes(lock.read_bytes()[:-20])
    found = terms_store.read(bench_at(lab))
    assert found is not None and found.left is None and set(found.end) == {"shut", "lamps off"}


def test_one_that_is_taken_up_before_that_is_held_again_and_nothing_is_shut(lab: Path) -> None:
    killed(begun(lab))
    with Bench.open(lab) as bench:
        assert bench.wait(bench.edge.hold(terms())) is None
        bench.recovery.settle()
        assert emits(bench)
        assert bench.wait(bench.edge.leave(NAME, True)).reached == ("shut", "lamps off", "parked")
        assert not emits(bench) and bench.wait(bench.edge.unattended()) is None


def test_the_edge_lets_no_light_out_above_the_class_whoever_asks_and_holds_one_run_at_a_time(lab: Path) -> None:
    with Bench.open(lab) as bench, Bench.open(lab) as other:
        bench.apply(bench.single("laser", "set", shutter="closed"))
        bench.wait(bench.edge.hold(terms(laser_class="2")))
        report = bench.apply(bench.single("laser", "set", shutter="open"))
        assert report.outcome == "failed" and "states 2 at the most" in report.diagnostics[0].summary
        with pytest.raises(PicoError) as caught:
            other.wait(other.edge.hold(terms(recipe="other@x")))
        assert caught.value.exit_code == ExitCode.LOCKED and NAME in str(caught.value)


def test_a_client_that_says_nothing_is_given_up(lab: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unattended, "SILENCE", 0.0)
    monkeypatch.setattr(unattended, "GRACE", 0.1)
    with Bench.open(lab) as bench:
        bench.wait(bench.edge.hold(terms(every=0.0)))
        left = left_of(bench)
        assert "said nothing" in left.why and not emits(bench)


def test_the_process_of_the_bench_shuts_it_when_it_ends(lab: Path) -> None:
    with Bench.open(lab) as bench:
        open_run(bench)
    with Bench.open(lab) as bench:
        assert not emits(bench)
        assert left_of(bench).why == "the process of the bench ended"
