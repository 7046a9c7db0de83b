"""A saved plan is applied only to what it was made for; --refresh makes a new one for the same goal."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from commanding import Answer, Brought, Pico, edit, succeed

PLAN = "e1.plan"


@pytest.fixture
def saved(shel: Path, brought: Brought) -> Path:
    brought(save_plan)
    return shel


def save_plan(_: Path) -> None:
    succeed("apply", "C3", "--auto-approve")
    succeed("plan", "e1", "--out", PLAN)


def git(*words: str) -> None:
    subprocess.run(["git", *words], check=True, capture_output=True)


def branch_moves(folder: Path, pico: Pico) -> None:
    git("branch", "--force", "e1", "e2")


def head_moves(folder: Path, pico: Pico) -> None:
    git("commit", "--allow-empty", "-m", "later")


def lab_edited(folder: Path, pico: Pico) -> None:
    edit(folder / "lab.yaml", "beam_height: 70", "beam_height: 70.2")
    assert pico("bench", "update", "--auto-approve").code == 0


def calibrated(folder: Path, pico: Pico) -> None:
    (folder / "calibration.json").write_text("{}")


def nudged(folder: Path, pico: Pico) -> None:
    pico("sim", "nudge", "p2", "--dx", "4", "--dyaw", "2")


def tuned(folder: Path, pico: Pico) -> None:
    assert pico("set", "p1", "angle=60", "-y").code == 0


def taken(folder: Path, pico: Pico) -> None:
    pico("sim", "remove", "ly_200")


@pytest.mark.parametrize(("change", "said"), [
    (nudged, "p2 changed by 4 mm, 2°, tolerance 0.5 mm, 0.5°: (524, 420, 2°), planned from (520, 420, 0°)"),
    (tuned, "p1.angle changed by 30 deg, tolerance 0.1: 60, planned from 90"),
    (taken, "ly_200 is missing now"),
    (lab_edited, "the lab or its component types were edited since: table.beam_height 70 → 70.2"),
    (head_moves, "HEAD is "),
    (calibrated, "the calibration of the cameras is "),
    (branch_moves, "e1 is "),
])  # fmt: skip
def test_what_has_changed_since_is_named_and_nothing_moves(
    saved: Path, pico: Pico, change: Callable[[Path, Pico], None], said: str
) -> None:
    change(saved, pico)
    before = pico("catalog", "parts", "--json").out
    shown = pico("plan", PLAN)
    assert shown.code == 4 and said in shown.err.replace("\n        ", " ") and "can't be applied" in shown.out, shown
    refused = pico("apply", PLAN, "--auto-approve")
    assert refused.code == 4
    assert said in refused.err.replace("\n        ", " ")
    assert pico("catalog", "parts", "--json").out == before


def test_a_plan_to_the_manifest_is_stale_once_that_is_edited(shel: Path, pico: Pico) -> None:
    pico("plan", "--out", "my.plan")
    edit(shel / "state" / "table.yaml", "x: 520", "x: 530")
    refused = pico("apply", "my.plan", "--auto-approve")
    assert refused.code == 4
    assert "the manifest was edited since: p2 moved 10 mm" in refused.err


def test_refresh_plans_anew_for_the_same_goal(saved: Path, pico: Pico) -> None:
    nudged(saved, pico)
    done: Answer = pico("apply", PLAN, "--refresh", "--auto-approve")
    assert done.code == 0
    assert "The bench equals e1." in done.out
    assert pico("apply", "e1", "--refresh").code == 1


def test_a_plan_that_still_fits_is_applied(saved: Path, pico: Pico) -> None:
    pico("sim", "nudge", "p2", "--dx", "0.1")
    assert pico("apply", PLAN, "--auto-approve").code == 0


def test_what_its_edge_would_refuse_now_is_said_when_it_is_shown_and_before_anything_is_asked(
    shel: Path, pico: Pico
) -> None:
    part = "    type: half_wave_plate\n"
    edit(shel / "lab.yaml", part, f"{part}    sample: WSe2-041\n    dose_budget: 10\n")
    for part, value in (("p1", "angle=3"), ("laser", "emission=true"), ("laser", "shutter=open")):
        assert pico("set", part, value, "-y").code == 0
    assert pico("plan", "e1", "--out", "my.plan", "--", "p1.angle").code == 0
    assert pico("plan", "my.plan").code == 0
    assert pico("sim", "wait", "4.9s").code == 0  # the sample gets most of its budget; nothing else changes
    shown, refused = pico("plan", "my.plan"), pico("apply", "my.plan")
    for answer in (shown, refused):
        assert answer.code == 7 and "of its 10 mJ" in answer.err, answer
    assert "can't be applied" in shown.out and "angle" not in refused.out, "it is refused before it is asked about"
    data = pico("plan", "my.plan", "--json").data
    assert [one["code"] for one in data["diagnostics"] if one["severity"] == "error"] == ["dose"]
