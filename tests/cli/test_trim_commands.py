"""What light found on a bench is its own: plans keep it, captures and commits write it."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
import yaml
from commanding import Brought, Pico, edit, succeed, with_goals
from test_optimize_command import GOALS


@pytest.fixture
def aligned(shel: Path, brought: Brought) -> Path:
    brought(center_spot)
    return shel


def center_spot(folder: Path) -> None:
    """The case study in a world that errs, its spot centered by the goal of the lab."""
    subprocess.run(["git", "checkout", "-q", "e1"], cwd=folder, check=True)
    edit(folder / "lab.yaml", "  seed: 1\n", "  seed: 1\n  errors: {seat: 1}\n")
    with_goals(folder / "lab.yaml", GOALS)
    succeed("apply", "--yes")
    succeed("optimize", "centred", "--yes")


def stage(pico: Pico) -> float:
    value: float = pico("get", "ly_150.stage_y", "--json").data["values"]["stage_y"]["value"]
    return value


def test_a_plan_keeps_what_light_found_and_nothing_counts_it_as_a_difference(aligned: Path, pico: Pico) -> None:
    assert abs(stage(pico)) > 0.005, "or there is nothing to keep"
    answer = pico("plan", "--detailed-exitcode")
    assert answer.code == 0
    said = " ".join(answer.out.split())
    assert "not 0: centred was met there" in said and "the bench equals the manifest, except ly_150.stage_y" in said
    (change,) = (c for c in pico("plan", "--json").data["changes"] if c["tunable"] == "stage_y")
    assert change["tolerated"] and change["aligned"]["goal"] == "centred"
    assert pico("drift").code == 0 and "No drift" in pico("drift").out
    status = pico("status")
    assert "!" not in next(line for line in status.out.splitlines() if "ly_150.stage_y" in line)
    assert "kept: centred has the last word" in status.out and "except for" not in status.out
    assert "ly_150.stage_y and ly_150.stage_z stay where centred has the last word" in " ".join(
        pico("verify").out.split()
    )
    found = stage(pico)
    assert pico("apply", "--yes").code == 0 and stage(pico) == found


def test_capture_and_commit_write_what_light_found_and_say_so(aligned: Path, pico: Pico) -> None:
    table = aligned / "state" / "table.yaml"
    answer = pico("commit", "-m", "aligned")
    assert answer.code == 0, answer.err
    assert f"Wrote the aligned values of centred: ly_150.stage_y {stage(pico):.2f}"[:-1] in answer.out
    written = yaml.safe_load(table.read_text())["components"]["ly_150"]["stage_y"]
    assert written == pytest.approx(stage(pico), abs=0.005) and written != 0
    assert "hand" not in subprocess.run(["git", "log", "-1"], capture_output=True, text=True, check=True).stdout.lower()
    answer = pico("capture")
    assert answer.code == 0 and "Nothing to capture" in answer.out
    assert all(not row["kept"] for row in pico("status", "--json").data["rows"])


def test_an_edit_of_an_aligned_value_is_not_applied_unless_it_is_named(aligned: Path, pico: Pico) -> None:
    found = stage(pico)
    assert pico("commit", "-m", "aligned").code == 0
    table = aligned / "state" / "table.yaml"
    table.write_text(re.sub(r"stage_y: .*", "stage_y: 0.9", table.read_text(), count=1))
    assert pico("apply", "--yes").code == 0 and stage(pico) == found
    refused = pico("commit", "-m", "edited")
    assert refused.code == 1 and "`pico apply -- ly_150.stage_y` first" in refused.err
    assert pico("apply", "--yes", "--", "ly_150.stage_y").code == 0 and stage(pico) == 0.9


def test_exact_means_the_value(aligned: Path, pico: Pico) -> None:
    assert pico("apply", "--exact", "--yes").code == 0 and stage(pico) == 0


def test_a_plan_that_makes_a_goal_stale_keeps_what_light_found_and_says_what_to_align_again(
    aligned: Path, pico: Pico
) -> None:
    found = stage(pico)
    edit(aligned / "state" / "table.yaml", "    angle: 22.75", "    angle: 22")
    told = " ".join(pico("plan").out.split())
    assert "align again: centred (hwp.angle changes; met" in told and "`pico optimize centred`" in told
    assert pico("apply", "--yes").code == 0 and stage(pico) == found
    told = " ".join(pico("plan").out.split())
    assert "align again: centred (hwp.angle was changed since" in told, "it is still said while it is stale"
    assert pico("plan", "--detailed-exitcode").code == 0


def test_an_older_layout_has_its_own_values_back_and_a_layout_never_aligned_keeps_the_live_ones(
    aligned: Path, pico: Pico
) -> None:
    assert pico("commit", "-m", "aligned at e1").code == 0
    at_e1 = yaml.safe_load((aligned / "state" / "table.yaml").read_text())["components"]["ly_150"]["stage_y"]
    table = aligned / "state" / "table.yaml"
    parts = yaml.safe_load(table.read_text())["components"]
    moved = {**parts["ly_150"]["pose"], "y": parts["ly_150"]["pose"]["y"] + 0.8}
    text = table.read_text()
    start = text.index("ly_150:")
    table.write_text(text[:start] + text[start:].replace(f"y: {parts['ly_150']['pose']['y']}", f"y: {moved['y']}", 1))
    before = stage(pico)
    assert pico("apply", "--yes").code == 0 and stage(pico) == before, "never aligned there"
    assert pico("optimize", "centred", "--yes").code == 0
    there = stage(pico)
    assert abs(there - at_e1) > 0.4, "the other place needs another value"
    assert pico("commit", "-m", "aligned beside it").code == 0
    assert pico("apply", "HEAD~1", "--yes").code == 0
    assert stage(pico) == pytest.approx(at_e1, abs=1e-6), "it was met with that, where the lens stands again"
    assert pico("apply", "HEAD~2", "--yes").code == 0
    assert stage(pico) == pytest.approx(at_e1, abs=1e-6), "0 was never met"
    assert pico("apply", "HEAD", "--yes").code == 0 and stage(pico) == pytest.approx(there, abs=0.006)


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
        ("{stage_q: {kind: align}}", "`stage_y` or `stage_z`"),
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


READY = ("optimize", "center", "ly_150", "cam", "--yes")


@pytest.fixture
def placed(shel: Path, brought: Brought) -> Path:
    brought(without_goals)
    return shel


def without_goals(folder: Path) -> None:
    """The case study in a world that errs, of whose stage no goal of the lab and no manifest says anything."""
    subprocess.run(["git", "checkout", "-q", "e1"], cwd=folder, check=True)
    edit(folder / "lab.yaml", "  seed: 1\n", "  seed: 1\n  errors: {seat: 1}\n")
    with_goals(folder / "lab.yaml", "")
    table = folder / "state" / "table.yaml"
    named = yaml.safe_load(table.read_text())["components"]["ly_150"]
    for tunable in ("stage_y", "stage_z"):
        edit(table, f"    {tunable}: {named[tunable]}\n", "")
    succeed("bench", "update", "--yes")
    succeed("apply", "--yes")
    succeed("commit", "-m", "without stages")


@pytest.mark.parametrize("how", ["capture", "commit"])
def test_what_a_ready_made_goal_found_is_written_though_the_manifest_does_not_name_it(
    placed: Path, pico: Pico, how: str
) -> None:
    assert pico(*READY).code == 0
    found = stage(pico)
    answer = pico("commit", "-m", "aligned") if how == "commit" else pico("capture")
    assert answer.code == 0, answer.err
    assert "Wrote the aligned values of center ly_150 cam: ly_150.stage_y" in " ".join(answer.out.split())
    written = yaml.safe_load((placed / "state" / "table.yaml").read_text())["components"]["ly_150"]
    assert written["stage_y"] == pytest.approx(found, abs=0.005) and "stage_z" in written
    assert "Nothing to capture" in pico("capture").out


def test_what_a_commit_does_not_carry_of_an_alignment_it_names(placed: Path, pico: Pico) -> None:
    assert pico(*READY).code == 0
    edit(placed / "state" / "table.yaml", "    angle: 22.75", "    angle: 22")
    answer = pico("commit", "-m", "planned", "--planned")
    said = " ".join(answer.err.split())
    assert answer.code == 0, answer.err
    assert "center ly_150 cam found ly_150.stage_y and ly_150.stage_z, and the commit does not hold" in said
    assert "`pico capture ly_150.stage_y ly_150.stage_z`" in said
    assert pico("set", "ly_150.stage_y=1", "--yes").code == 0
    assert "found" not in pico("commit", "-m", "set", "--capture").err, "it was set otherwise since: nothing is lost"
