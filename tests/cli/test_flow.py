"""The main job by command: plan, apply, drift, checkout, capture, commit."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

from commanding import Pico, Typed, edit

P2 = "  p2:\n    pose:\n      x: 520"


def test_an_old_experiment_comes_back_and_a_nudge_is_found(shel: Path, pico: Pico) -> None:
    planned = pico("plan", "e1", "--detailed-exitcode")
    assert planned.code == 2
    assert 'HEAD C3 → e1 (E1-3 "tilt of p2, lens pair 125/150")' in planned.out
    assert "storage/a3 → (395, 420, 0°)" in planned.out
    assert "Apply with `pico apply e1`" in planned.out

    applied = pico("apply", "e1", "--auto-approve")
    assert applied.code == 0, applied
    assert (
        "The bench equals e1.\nThe manifest still describes another state: `pico apply` returns the bench to it"
        in applied.out
    )

    again = pico("plan", "e1", "--detailed-exitcode")
    assert again.code == 0
    assert "Nothing to do: the bench equals e1." in again.out

    assert pico("sim", "nudge", "p2", "--dx", "5").code == 0
    nudged = pico("plan", "e1", "--detailed-exitcode")
    assert nudged.code == 2
    assert "moved 5 mm" in nudged.out
    assert "1 move " in nudged.out


def test_lines_fit_a_hundred_columns(shel: Path, pico: Pico) -> None:
    pico("apply", "e1", "--auto-approve")
    for words in (
        ["plan", "e3"],
        ["status"],
        ["diff", "C3", "E1-3"],
        ["log", "--graph"],
        ["log"],
        ["catalog", "parts"],
        ["show"],
    ):
        answer = pico(*words)
        assert answer.code == 0
        assert max(len(line) for line in answer.out.splitlines()) <= 100, (words, answer.out)


def test_a_declined_apply_moves_nothing_and_exits_1(shel: Path, pico: Pico, monkeypatch) -> None:
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    answer = pico("apply", "e1")
    assert answer.code == 1
    assert "Nothing moved." in answer.out
    assert pico("plan", "e1", "--detailed-exitcode").code == 2


def test_nobody_at_the_terminal_is_a_no(shel: Path, pico: Pico, monkeypatch) -> None:
    monkeypatch.setattr("sys.stdin", Typed(""))
    assert pico("apply", "e1").code == 1


def test_a_yes_is_enough(shel: Path, pico: Pico, monkeypatch) -> None:
    monkeypatch.setattr("sys.stdin", Typed("y\n"))
    answer = pico("apply", "e1")
    assert answer.code == 0
    assert (
        "Run 4 moves, 6 settings on sim (kinematic) and let light out (laser.emission, laser.shutter)? [y/N]"
        in answer.out
    )


def test_a_saved_plan_is_applied_and_refused_once_the_bench_has_changed(shel: Path, pico: Pico) -> None:
    assert pico("plan", "e1", "--out", "e1.plan").code == 0
    assert pico("show", "e1.plan").out.startswith("shel")
    assert pico("apply", "e1.plan", "--auto-approve").code == 0
    stale = pico("apply", "e1.plan", "--auto-approve")
    assert stale.code == 4
    assert "error[stale]" in stale.err
    assert "p2" in stale.err


def test_a_changed_plan_file_is_refused(shel: Path, pico: Pico) -> None:
    pico("plan", "e1", "--out", "e1.plan")
    edit(shel / "e1.plan", '"makespan":', '"makespan":1')
    answer = pico("apply", "e1.plan", "--auto-approve")
    assert answer.code == 1
    assert "error[plan-file]" in answer.err


def test_a_name_that_is_both_file_and_revision_must_be_told_apart(shel: Path, pico: Pico) -> None:
    pico("plan", "e1", "--out", "e2")
    answer = pico("apply", "e2", "--auto-approve")
    assert answer.code == 1
    assert "`e2` is both a file and a revision" in answer.err
    applied = pico("apply", "./e2", "--auto-approve")
    assert applied.code == 0
    assert "The bench equals e1." in applied.out


def test_checkout_moves_files_and_bench(shel: Path, pico: Pico) -> None:
    answer = pico("checkout", "e2", "--auto-approve")
    assert answer.code == 0, answer
    assert "The bench equals e2." in answer.out
    branch = subprocess.run(["git", "branch", "--show-current"], capture_output=True, text=True, check=True).stdout
    assert branch.strip() == "e2"
    assert pico("plan", "--detailed-exitcode").code == 0


def test_checkout_brings_a_state_back_to_the_bench_as_it_is_now(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "lab.yaml", "seed: 1", "seed: 2")
    subprocess.run(["git", "commit", "-qam", "another seed"], check=True)
    assert pico("bench", "update", "--auto-approve").code == 0
    answer = pico("checkout", "e1", "--auto-approve")
    assert answer.code == 0, answer
    assert "warning[lab-differs]: since e1 the bench was changed: sim.seed 1 → 2" in answer.err
    assert "The bench equals e1." in answer.out


def test_checkout_refuses_to_lose_edits(shel: Path, pico: Pico) -> None:
    edit(shel / "state" / "table.yaml", "angle: 90", "angle: 80")
    answer = pico("checkout", "e2", "--auto-approve")
    assert answer.code == 1
    assert "error[edited]" in answer.err
    assert "state/table.yaml" in answer.err


def test_git_checkout_and_plan_are_enough(shel: Path, pico: Pico) -> None:
    subprocess.run(["git", "checkout", "-q", "e2"], check=True)
    answer = pico("plan")
    assert "HEAD E2-3 → the manifest" in answer.out
    assert "lx_100" in answer.out


def test_an_impossible_state_names_both_and_exits_3(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "state" / "table.yaml", P2, P2.replace("520", "310"))
    for words in (["plan"], ["apply", "--auto-approve"]):
        answer = pico(*words)
        assert answer.code == 3
        assert "error[impossible]: p2 cannot stand at (310, 420, 0°)" in answer.err
        assert "p1" in answer.err
        assert "--> state/table.yaml:" in answer.err
        assert "x: 310" in answer.err


def test_status_has_three_columns_that_tell_an_edit_from_a_drift(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    assert "Committed, desired and live are equal." in pico("status").out
    pico("sim", "nudge", "p1", "--dx", "3")
    edit(shel / "state" / "table.yaml", P2, P2.replace("520", "505"))
    rows = {line.split()[0]: line for line in pico("status").out.splitlines() if line}
    assert "(505, 420, 0°) *" in rows["p2"]
    assert "(293, 420, 0°) !" in rows["p1"]
    data = {r["component"]: r for r in pico("status", "--json").data["rows"] if r["tunable"] == "pose"}
    assert (data["p2"]["edited"], data["p2"]["off"], data["p2"]["drifted"]) == (True, True, False)
    assert (data["p1"]["edited"], data["p1"]["off"], data["p1"]["drifted"]) == (False, True, True)


def test_drift_is_committed_against_live(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    assert "No drift" in pico("drift").out
    pico("sim", "nudge", "p2", "--dy", "-2")
    answer = pico("drift", "--detailed-exitcode")
    assert answer.code == 2
    assert "moved 2 mm" in answer.out


def test_capture_changes_the_lines_of_what_moved(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    pico("sim", "nudge", "p2", "--dx", "5")
    answer = pico("capture")
    assert "Captured 1 tunable into state/table.yaml" in answer.out
    changed = subprocess.run(["git", "diff", "--numstat"], capture_output=True, text=True, check=True).stdout
    assert changed.split()[:2] == ["1", "1"]
    assert "Nothing to capture" in pico("capture").out


def test_capture_takes_a_nudge_inside_a_slot_where_the_manifest_has_a_pose(shel: Path, pico: Pico) -> None:
    edit = Path("state/table.yaml")
    head, rest = edit.read_text().split("  p2:\n")
    edit.write_text(f"{head}  p2:\n    pose: {{x: 200, y: 215, yaw: 90}}\n{rest[rest.index('    angle') :]}")
    assert pico("apply", "--auto-approve").code == 0
    assert pico("plan", "--detailed-exitcode").code == 0
    pico("sim", "nudge", "p2", "--dx", "4")
    assert pico("plan", "--detailed-exitcode").code == 2
    assert "p2" in pico("drift").out
    assert "Captured 1 tunable" in pico("capture").out
    assert "pose: {x: 204, y: 215, yaw: 90}" in edit.read_text()
    assert pico("plan", "--detailed-exitcode").code == 0
    assert "Nothing to capture" in pico("capture").out


def test_commit_takes_the_bench_along_and_says_what_changed(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    assert pico("set", "p1", "angle=3", "-y").code == 0
    answer = pico("commit", "-m", "p1 three degrees from crossed")
    assert answer.code == 0, answer
    assert "p1.angle  90 → 3 deg" in answer.out
    message = subprocess.run(["git", "log", "-1", "--format=%B"], capture_output=True, text=True, check=True).stdout
    assert "Pico-State: sha256:" in message
    assert "Pico-Evidence: kinematic" in message


def test_commit_refuses_edits_that_were_never_applied_unless_told_who_wins(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "state" / "table.yaml", P2, P2.replace("520", "505"))
    refused = pico("commit", "-m", "move p2")
    assert refused.code == 1
    assert "never applied: p2" in refused.err
    planned = pico("commit", "-m", "move p2", "--planned")
    assert planned.code == 0
    assert "Committed as planned: not compared with the bench yet" in planned.out
    assert "\nPico-Evidence: planned\n" in pico("show", "--json").data["message"]


def test_commit_with_capture_lets_the_bench_win(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    edit(shel / "state" / "table.yaml", P2, P2.replace("520", "505"))
    pico("sim", "nudge", "p1", "--dx", "4")
    answer = pico("commit", "-m", "as it stands", "--capture")
    assert answer.code == 0, answer
    text = (shel / "state" / "table.yaml").read_text()
    assert "x: 520" in text
    assert "x: 294" in text


def test_a_first_commit_refuses_a_state_that_was_never_applied(shel: Path, pico: Pico) -> None:
    assert pico("init", "fresh").code == 0
    refused = pico("-C", "fresh", "commit", "-m", "first")
    assert refused.code == 1
    assert "error[unapplied]" in refused.err
    assert pico("-C", "fresh", "apply", "--auto-approve").code == 0
    assert pico("-C", "fresh", "commit", "-m", "first").code == 0


def test_a_lab_outside_git_can_be_planned_but_has_no_history(shel: Path, pico: Pico) -> None:
    import shutil

    shutil.rmtree(".git")
    assert pico("plan", "--detailed-exitcode").code == 2
    assert pico("apply", "--auto-approve").code == 0
    assert pico("status").code == 0
    for words in (["log"], ["diff"], ["plan", "e1"], ["drift"], ["commit", "-m", "x"]):
        answer = pico(*words)
        assert answer.code == 1
        assert "git init" in answer.err, words


def test_apply_as_json_is_the_plan_the_events_and_the_report(shel: Path, pico: Pico) -> None:
    lines = [json.loads(line) for line in pico("apply", "e1", "--auto-approve", "--json").out.splitlines()]
    assert lines[0]["schema"] == "pico.plan/v1"
    assert {line["schema"] for line in lines[1:-1]} == {"pico.event/v1"}
    assert lines[-1]["schema"] == "pico.report/v1"
    assert lines[-1]["outcome"] == "done"
    assert lines[-1]["remaining"] == []
    asked = pico("apply", "C1", "--json")
    assert asked.code == 1
    assert "auto-approve" in asked.data["diagnostics"][0]["hint"]


def test_how_far_a_part_stands_off_the_centre_of_a_slot_is_said_and_what_stays_in_one_does_not_leave_it(
    shel: Path, pico: Pico
) -> None:
    assert pico("sim", "nudge", "p1", "--dx", "9", "--dyaw", "45").code == 0
    (row,) = (line for line in pico("status").out.splitlines() if line.startswith("p1 "))
    assert row.endswith("storage/b1, 9 mm and 45° off its center !")
    assert pico("capture", "p1").code == pico("sim", "nudge", "p1", "--dx", "-5").code == 0
    (row,) = (line for line in pico("status").out.splitlines() if line.startswith("p1 "))
    assert row.endswith("(114, 220, 45°) !")
    assert re.search(r"~ p1 +\(114, 220, 45°\) → \(119, 220, 45°\) .* moved 5 mm", pico("plan").out)
