"""`pico calibrate twin`: a bench that errs otherwise than its lab declares teaches its twin to err so, too."""

from __future__ import annotations

import json
import math
import statistics
from pathlib import Path

import pytest
from commanding import Pico, edit

import pico as library
from pico.history.runs.loading import load_runs
from pico.model.trace.learned import Estimate, Learned, Scatter
from pico.runs.lessons import Lessons, lessons
from pico.twin.learned import write_learned

PART, TYPE = "lens", "plano_convex_100"
TRUE = Learned(
    types={TYPE: Scatter(position=Estimate(value=0.16, sigma=0, count=1, before=0),
                         yaw=Estimate(value=0.11, sigma=0, count=1, before=0))},
    times={"move arm1": Estimate(value=1.35, sigma=0, count=1, before=1)},
)  # fmt: skip
"""How the bench errs in truth. Its lab declares 0.1 mm and 0.05 deg, and a plan reckons with 1."""
MOVES, HELD_OUT = 14, 6


@pytest.fixture
def minimal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, pico: Pico) -> Path:
    """The example with a laser, a lens and a camera, which declares that placements err as its types repeat."""
    monkeypatch.chdir(tmp_path)
    assert pico("init", "--example", "minimal", "m").code == 0
    monkeypatch.chdir(tmp_path / "m")
    edit(tmp_path / "m" / "lab.yaml", "inventory:\n", "sim:\n  errors: {seat: 1}\ninventory:\n")
    return tmp_path / "m"


def moved(root: Path, count: int) -> tuple[list[str], Lessons]:
    """Put the lens down so often, to and fro, and return these runs and what they tell."""
    with library.open(root) as bench:
        for n in range(count):
            x, y = ((520.0, 420.0), (560.0, 440.0))[n % 2]
            bench.apply(bench.single(PART, "move", x=x + n % 5, y=y, yaw=0))
        names = [run.id for run, _ in bench.history.runs()[:count]]
        return names, lessons(bench.setup, load_runs(bench.folder, names, []))


def both(told: Lessons) -> list[float]:
    return [axis for off in told.placed for axis in (off.x, off.y)]


def surprise(errors: list[float], sigma: float) -> float:
    return statistics.fmean(math.log(sigma) + (one / sigma) ** 2 / 2 for one in errors)


@pytest.mark.slow
def test_the_twin_then_errs_as_the_bench_does_and_predicts_runs_that_it_never_saw(minimal: Path, pico: Pico) -> None:
    write_learned(minimal, TRUE)
    runs, _ = moved(minimal, MOVES)
    _, held_out = moved(minimal, HELD_OUT)
    (minimal / "twin.json").unlink()

    told = pico("calibrate", "twin", *runs, "--dry-run")
    assert told.code == 0 and "Nothing was written" in told.out and not (minimal / "twin.json").exists()
    (line,) = (line for line in told.out.splitlines() if f"{TYPE}, position" in line)
    assert "0.100 mm" in line and "±" in line and "All operations took" in told.out

    answer = pico("calibrate", "twin", *runs, "--json")
    rows = {row["what"]: row for row in answer.data["rows"]}
    position, yaw, time = rows[f"{TYPE}, position"], rows[f"{TYPE}, yaw"], rows["move arm1"]
    assert (position["before"], yaw["before"], time["before"]) == (0.1, 0.05, 1.0)
    for row, true in ((position, 0.16), (yaw, 0.11), (time, 1.35)):
        assert row["count"] == MOVES and abs(row["measured"] - true) < 3 * row["sigma"] + 1e-6
        assert row["after"] == row["measured"]
    assert surprise(both(held_out), position["after"]) < surprise(both(held_out), position["before"])
    ratios = [m / p for m, p in held_out.times["move arm1"]]
    assert statistics.fmean(abs(r - time["after"]) for r in ratios) < statistics.fmean(abs(r - 1) for r in ratios)

    document = json.loads((minimal / "twin.json").read_text())
    assert document["schema"] == "pico.twin/v1" and document["evidence"] == "kinematic"
    assert document["runs"] == sorted(runs) and "noise" not in document
    _, again = moved(minimal, HELD_OUT)
    assert statistics.pstdev(both(again)) == pytest.approx(position["after"], rel=0.5)
    assert [m / p for m, p in again.times["move arm1"]] == pytest.approx([time["after"]] * HELD_OUT, rel=1e-3)


def test_without_runs_of_the_bench_itself_there_is_nothing_to_learn_from(minimal: Path, pico: Pico) -> None:
    answer = pico("calibrate", "twin")
    assert answer.code == 1 and "nothing to learn from" in answer.err and "where they are named" in answer.err
    wrong = pico("calibrate", "twin", "--since", "yesterday")
    assert wrong.code == 1 and "no day and no time" in wrong.err
