"""A state that cannot stand: exit code 3 where it is wanted on a bench, an error of `validate` where it is written."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico, edit
from killed_commands import git
from test_stopping_commands import started

P2 = "  p2:\n    pose:\n      x: 520"
WRONG = {
    "off the table": (P2, P2.replace("520", "5200"), "p2 cannot stand at (5200, 420, 0°)", "state/table.yaml:44:10"),
    "over the edge": (P2, P2.replace("520", "5"), "stick out 25 mm over the table's edge", "state/table.yaml:44:10"),
    "two parts": (P2, P2.replace("520", "300"), "p1 cannot stand at (290, 420, 0°)", "state/table.yaml:38:10"),
    "a bolted part": (P2, P2.replace("520", "222"), "it would overlap hwp", "state/table.yaml:"),
}


@pytest.mark.parametrize("case", WRONG)
def test_it_is_said_by_plan_and_apply_with_3_and_by_validate_and_check(shel: Path, pico: Pico, case: str) -> None:
    before, after, text, place = WRONG[case]
    edit(shel / "state" / "table.yaml", before, after)
    wanted = {"plan": 3, "apply --auto-approve": 3, "check": 3, "commit --planned -m x": 3, "validate": 1, "fmt": 0}
    for words, code in wanted.items():
        answer = pico(*words.split())
        assert answer.code == code, words
        assert code == 0 or (text in answer.err and f"--> {place}" in answer.err), words
    assert pico("status").code == 0 and git(shel, "log", "-1", "--format=%s") != "x"


def test_a_keep_out_counts_and_a_branch_that_cannot_stand_is_not_merged(shel: Path, pico: Pico) -> None:
    git(shel, "checkout", "-qb", "wrong")
    edit(shel / "state" / "table.yaml", *WRONG["off the table"][:2])
    git(shel, "commit", "-qam", "too far")
    git(shel, "checkout", "-q", "main")
    git(shel, "commit", "-q", "--allow-empty", "-m", "else")
    answer = pico("merge", "wrong")
    assert answer.code != 0 and "p2 cannot stand" in answer.err
    with (shel / "lab.yaml").open("a") as lab:
        lab.write("keep_out:\n  pump: {area: {x: [500, 560], y: [400, 440]}}\n")
    answer = pico("validate")
    assert answer.code == 1 and "p2 cannot stand" in answer.err and "keep-out pump" in answer.err


def finished(process: subprocess.Popen[str], shel: Path) -> str:
    (shel / ".pico" / "goes_on").write_text("")
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    return out


def test_a_manifest_edited_during_an_apply_is_not_said_to_be_reached(shel: Path) -> None:
    process = started(shel, "apply", "--auto-approve")
    edit(shel / "state" / "table.yaml", P2, P2.replace("520", "620"))
    assert "The bench equals the manifest as it was when it was planned; it was edited since." in finished(
        process, shel
    )


def test_a_file_that_was_only_touched_or_commented_is_still_the_manifest(shel: Path) -> None:
    process = started(shel, "apply", "--auto-approve")
    path = shel / "state" / "table.yaml"
    path.write_text(f"# a word\n{path.read_text()}")
    assert "The bench equals the manifest." in finished(process, shel)


@pytest.mark.slow
def test_a_checkout_during_an_apply_is_told_and_a_revision_stays_what_it_is(shel: Path) -> None:
    process = started(shel, "apply", "--auto-approve")
    git(shel, "checkout", "-q", "e1")
    assert "as it was when it was planned; it was edited since" in finished(process, shel)
    for name in ("waits", "goes_on"):
        (shel / ".pico" / name).unlink()
    process = started(shel, "apply", "e2", "--auto-approve")
    git(shel, "checkout", "-q", "e3")
    assert "The bench equals e2." in finished(process, shel)


def test_a_branch_that_moved_during_an_apply_is_told(shel: Path) -> None:
    commit = git(shel, "rev-parse", "--short=7", "e1")
    process = started(shel, "apply", "e1", "--auto-approve")
    git(shel, "branch", "-f", "e1", "e2")
    assert f"The bench equals e1 as it was when it was planned ({commit})." in finished(process, shel)


def test_bolted_parts_in_one_another_are_found_by_validate(shel: Path, pico: Pico) -> None:
    assert "bolted" not in pico("validate").err
    edit(shel / "lab.yaml", "pose: {x: 222, y: 420, yaw: 0}", "pose: {x: 130, y: 420, yaw: 0}")
    answer = pico("validate")
    assert "hwp is bolted at (130, 420, 0°) and laser at (120, 420, 0°): their bases would overlap by" in answer.err
    assert "state/table.yaml:" in answer.err and answer.code == 0
