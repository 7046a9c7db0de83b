"""A tunable whose goal is aligned is as it is committed anywhere within its trim; else its value counts."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
import yaml
from commanding import Pico, edit, with_goals
from test_optimize_command import GOALS


@pytest.fixture
def aligned(shel: Path, pico: Pico) -> Path:
    """The case study in a world that errs, its spot centred by the goal of the lab."""
    subprocess.run(["git", "checkout", "-q", "e1"], cwd=shel, check=True)
    edit(shel / "lab.yaml", "  seed: 1\n", "  seed: 1\n  errors: {seat: 1}\n")
    with_goals(shel / "lab.yaml", GOALS)
    assert pico("apply", "--yes").code == 0
    assert pico("optimize", "centred", "--yes").code == 0
    return shel


def stage(pico: Pico) -> float:
    value: float = pico("get", "ly_150.stage_y", "--json").data["values"]["stage_y"]["value"]
    return value


def test_what_is_aligned_within_its_trim_is_no_change(aligned: Path, pico: Pico) -> None:
    assert abs(stage(pico)) > 0.005, "or there is nothing to tell"
    answer = pico("plan", "--detailed-exitcode")
    assert answer.code == 0
    assert "within its trim, stays; centred aligned" in " ".join(answer.out.split())
    (change,) = (c for c in pico("plan", "--json").data["changes"] if c["tunable"] == "stage_y")
    assert change["tolerated"] and change["aligned"]["goal"] == "centred"
    assert pico("drift").code == 0 and "No drift" in pico("drift").out
    assert all(row["tunable"] != "stage_y" or not row["off"] for row in pico("status", "--json").data["rows"])
    found = stage(pico)
    assert pico("apply", "--yes").code == 0 and stage(pico) == found


def test_capture_leaves_it_unless_it_is_named(aligned: Path, pico: Pico) -> None:
    text = (aligned / "state" / "table.yaml").read_text()
    assert pico("capture").code == 0
    assert (aligned / "state" / "table.yaml").read_text() == text
    assert pico("capture", "ly_150.stage_y").code == 0
    written = yaml.safe_load((aligned / "state" / "table.yaml").read_text())["components"]["ly_150"]["stage_y"]
    assert written == pytest.approx(stage(pico), abs=0.005) and written != 0


def test_exact_means_the_value(aligned: Path, pico: Pico) -> None:
    assert pico("apply", "--exact", "--yes").code == 0 and stage(pico) == 0


def test_a_goal_that_is_stale_leaves_the_value_to_count(aligned: Path, pico: Pico) -> None:
    assert pico("set", "hwp.angle", "12", "--yes").code == 0
    plan = pico("plan", "--json").data
    assert {"ly_150.stage_y"} <= {f"{o['component']}.{o['arguments'].get('tunable')}" for o in plan["operations"]}


def test_a_plan_that_makes_it_stale_sets_the_value_and_ends_where_a_plan_finds_nothing(
    aligned: Path, pico: Pico
) -> None:
    edit(aligned / "state" / "table.yaml", "    angle: 22.75", "    angle: 22")
    assert pico("apply", "--yes").code == 0
    assert stage(pico) == 0 and pico("plan", "--detailed-exitcode").code == 0


def test_what_was_seen_of_how_parts_stand_is_made_up_for_first(aligned: Path, pico: Pico) -> None:
    *first, last = pico("runs", "show", "--json").data["operations"]
    assert {(one["primitive"], one["component"]) for one in first} == {("set", "ly_150")}
    assert last["primitive"] == "optimize"
    assert pico("optimize", "centred", "--yes").code == 0
    assert len(pico("runs", "show", "--json").data["operations"]) == 1, "nothing was put down since"
    assert pico("sim", "nudge", "ly_150", "--dy", "0.2").code == 0
    before = stage(pico)
    found = json.loads(pico("optimize", "centred", "--yes", "--json").out.splitlines()[-1])
    assert found["first"]["ly_150.stage_y"] == pytest.approx(before - 0.2, abs=0.01)
    assert abs(found["first"]["cam.centroid.x"]) < 20, "it is there nearly before it is sought"
    assert pico("undo", "--yes").code == 0 and stage(pico) == pytest.approx(before, abs=1e-6)


def test_of_a_set_point_the_value_counts(aligned: Path, pico: Pico) -> None:
    own = "ly_150:\n    restore: {stage_y: {kind: setpoint}, stage_z: {kind: setpoint}}\n"
    edit(aligned / "lab.yaml", "ly_150:\n", own)
    assert pico("bench", "update", "--yes").code == 0
    assert pico("plan", "--detailed-exitcode").code == 2


@pytest.mark.parametrize(
    ("own", "said"),
    [
        ("{stage_q: {kind: align}}", "`stage_z` or `stage_y`"),
        ("{stage_y: {kind: align, trim: 1, goal: centered}}", "did you mean `centred`"),
        ("{stage_y: {kind: alighn}}", "kind"),
        ("{shutter: {kind: setpoint}}", "it stays a request"),
    ],
)
def test_what_a_part_says_of_its_own_is_checked(shel: Path, pico: Pico, own: str, said: str) -> None:
    with_goals(shel / "lab.yaml", GOALS)
    part = "laser:\n" if "shutter" in own else "ly_150:\n"
    edit(shel / "lab.yaml", part, f"{part}    restore: {own}\n")
    answer = pico("validate")
    assert answer.code == 1 and said in " ".join(answer.err.split()) and "lab.yaml:" in answer.err


@pytest.mark.parametrize("branch", ["main", "e1", "e2", "e3"])
def test_goals_of_lenses_in_storage_are_no_error_of_a_shipped_state(shel: Path, pico: Pico, branch: str) -> None:
    subprocess.run(["git", "checkout", "-q", branch], cwd=shel, check=True)
    answer = pico("validate")
    assert answer.code == 0, answer.err
