"""`pico commit`, `pico capture` and `pico note` as somebody at the bench uses them."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from commanding import Brought, Pico, apply_manifest, edit, succeed

from pico import open as open_bench

TABLE = Path("state/table.yaml")
P2 = "      x: 520\n"


def git(*words: str, ok: bool = True) -> str:
    done = subprocess.run(["git", *words], capture_output=True, text=True, check=False)
    assert not ok or done.returncode == 0, done.stderr
    return done.stdout


def body(revision: str = "HEAD") -> str:
    return git("log", "-1", "--format=%B", revision)


def trailer(key: str) -> list[str]:
    return [v for v in git("log", "-1", f"--format=%(trailers:key={key},valueonly)").splitlines() if v]


@pytest.fixture
def built(shel: Path, brought: Brought) -> Path:
    brought(apply_and_commit)
    return shel


def apply_and_commit(folder: Path) -> None:
    """The example with its bench built as the manifest says, and the run of that in a commit."""
    apply_manifest(folder)
    succeed("commit", "-m", "built")


def test_without_a_message_it_says_what_moved(built: Path, pico: Pico) -> None:
    pico("sim", "nudge", "p2", "--dx", "5", "--dyaw", "30")
    pico("set", "p1", "angle=1", "-y")
    assert pico("commit").code == 0
    subject, _, rest = body().partition("\n\n")
    assert subject == "p2 moved 5 mm, turned +30 deg; p1.angle 90 -> 1 deg"
    assert "p2 moved 5 mm (dx +5), turned +30 deg, from (520, 420, 0 deg) to (525, 420, 30 deg)\n" in rest
    assert git("show", "--numstat", "--format=", "HEAD", "--", "state").split()[:2] == ["3", "3"]


@pytest.mark.parametrize("message", ["", "  ", "\n"])
def test_an_empty_message_is_refused_before_anything_is_committed(built: Path, pico: Pico, message: str) -> None:
    pico("set", "p1", "angle=1", "-y")
    head, held = git("rev-parse", "HEAD"), (built / TABLE).read_text()
    refused = pico("commit", "-m", message)
    assert refused.code == 1 and "the message is empty: nothing was committed" in refused.err, refused
    assert (git("rev-parse", "HEAD"), (built / TABLE).read_text()) == (head, held)


def test_what_was_never_applied_is_not_undone_by_a_commit(built: Path, pico: Pico) -> None:
    for change in (("cherry-pick", "E2-1"), ("revert", "C3")):
        assert pico(*change).code == 0
        assert pico("note", "p1", "x").code == 0
        refused = pico("commit", "-m", "just a note")
        assert refused.code == 1 and "the last commit was never applied to this bench: " in refused.err
        assert ("lx_100" if "E2-1" in change else "p2") in refused.err
        assert pico("commit", "-m", "just a note", "--planned").code == 0
        assert "state/table.yaml" not in git("show", "--name-only", "--format=", "HEAD")
    git("checkout", "-q", "e2")
    assert "error[unapplied]" in pico("commit", "-m", "x").err
    assert pico("apply", "--auto-approve").code == 0
    assert pico("commit", "-m", "e2 as it is").code == 0


def test_what_keeps_edits_before_a_checkout_works_for_those_never_applied(built: Path, pico: Pico) -> None:
    edit(built / TABLE, P2, "      x: 530\n")
    refused = " ".join(pico("checkout", "e1", "--files-only").err.split())
    assert '`pico commit --planned -m "why"` keeps the edits' in refused, refused
    assert pico("commit", "-m", "why").code == 1
    assert pico("commit", "--planned", "-m", "why").code == 0
    assert pico("checkout", "e1", "--files-only").code == 0


def test_what_an_undo_or_a_script_left_is_committed(built: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GIT_COMMITTER_DATE", "2026-01-05T12:00:00Z")  # all that follows is later by whole seconds
    for angle in ("5", "6", "7"):
        assert pico("set", "p1", f"angle={angle}", "-y").code == 0
        assert angle != "5" or pico("commit", "-m", "five").code == 0
    assert pico("undo", "-y").code == 0
    assert pico("commit", "-m", "six").code == 0 and "angle: 6" in TABLE.read_text()
    assert pico("set", "p1", "angle=8", "-y").code == pico("commit", "-m", "eight").code == 0
    with open_bench(built) as bench, bench.record("turn"):
        bench["p1"].angle = 11
    assert pico("commit", "-m", "by a script").code == 0 and "angle: 11" in TABLE.read_text()


def test_an_undo_of_what_was_asked_for_does_not_hide_a_commit_that_was_never_applied(built: Path, pico: Pico) -> None:
    assert pico("apply", "e1", "--auto-approve").code == 0
    git("checkout", "-q", "e2")
    assert pico("undo", "--auto-approve").code == 0
    assert "error[unapplied]" in pico("commit", "-m", "x").err


def test_what_a_hand_does_again_and_again_is_captured_each_time(built: Path, pico: Pico) -> None:
    for x in (525, 530, 535):
        assert pico("sim", "nudge", "p2", "--dx", "5").code == 0
        assert pico("commit").code == 0
        assert f"x: {x}" in TABLE.read_text()
    assert pico("set", "p1", "angle=7", "-y").code == 0
    assert pico("commit", "-m", "by hand and by word").code == 0


def test_a_bench_that_only_hands_move_is_captured_after_its_first_commit(shel: Path, pico: Pico) -> None:
    assert pico("sim", "nudge", "ly_200", "--dy", "100").code == 0
    assert "error[unapplied]" in pico("commit").err
    assert pico("commit", "--capture").code == 0
    assert pico("sim", "nudge", "ly_200", "--dy", "20").code == 0
    assert pico("commit").code == 0


def test_many_changes_fit_the_first_line_and_are_all_in_the_body(built: Path, pico: Pico) -> None:
    parts = ("p1", "p2", "lx_100", "lx_125", "ly_150", "ly_200")
    for number, part in enumerate(parts):
        pico("sim", "nudge", part, "--dx", "-15" if part.startswith("l") else str(number + 3))
    assert pico("commit", "--capture").code == 0
    subject, _, rest = body().partition("\n\n")
    assert len(subject) <= 72 and "; and " in subject and subject.endswith(" more")
    assert all(f"{part} " in rest for part in parts)
    assert subject.isascii()


def test_ones_own_words_stay_as_they_are_and_trailers_join(built: Path, pico: Pico) -> None:
    pico("sim", "nudge", "p2", "--dx", "5")
    answer = pico("commit", "-m", "why: because", "-m", "# no comment\n\nCloses: 7", "--meta", "t=21.3 degC", "--json")
    assert answer.data["message"] == "why: because\n\n# no comment\n\nCloses: 7"
    assert answer.data["meta"] == {"t": "21.3 degC"} and answer.data["evidence"] == "kinematic"
    head, _, block = body().rstrip().rpartition("\n\n")
    assert head == "why: because\n\n# no comment"
    keys = [line.partition(":")[0] for line in block.splitlines()]
    assert keys == ["Closes", "Pico-State", "Pico-Evidence", "Pico-Lab", "Pico-Bench", "Pico-Hand", "Pico-Meta"]
    assert "t: 21.3 degC" in pico("show").out
    assert pico("log", "-n", "1", "--json").data["commits"][0]["meta"] == {"t": "21.3 degC"}


def test_the_editor_of_git_gets_the_message_first(built: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    pico("sim", "nudge", "p2", "--dx", "5")
    monkeypatch.setenv("GIT_EDITOR", "sed -i '/^#/!s/moved/shoved/'")
    assert pico("commit", "-e").code == 0
    assert body().startswith("p2 shoved 5 mm\n")
    pico("sim", "nudge", "p2", "--dx", "5")
    monkeypatch.setenv("GIT_EDITOR", "truncate -s 0")
    answer = pico("commit", "-e", "-m", "x")
    assert answer.code == 1 and "nothing was committed" in answer.err
    monkeypatch.setenv("GIT_EDITOR", "false")
    assert "error[editor]" in pico("commit", "-e", "-m", "x").err
    assert git("status", "--porcelain") == "", "what the bench showed is still on the bench alone"


def test_only_comments_changed_and_the_commit_says_so(built: Path, pico: Pico) -> None:
    edit(TABLE, "components:\n", "components:   # those on the table\n")
    assert pico("commit").code == 0
    assert body().startswith("Nothing on the table changed: comments or layout of state/table.yaml\n")
    assert trailer("Pico-Evidence") == ["kinematic"]
    made = git("rev-parse", "HEAD")
    again = pico("commit")
    assert again.code == 1 and "error[nothing-to-commit]" in again.err and "--allow-empty" in again.err
    assert git("rev-parse", "HEAD") == made
    assert pico("commit", "--allow-empty", "-m", "before lunch").code == 0
    assert git("rev-parse", "HEAD~1") == made and git("diff", "--stat", "HEAD~1") == ""


def test_only_what_is_named_is_captured_and_committed(built: Path, pico: Pico) -> None:
    (built / "state" / "hands.yaml").write_text(
        "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n  p2:\n    pose: {x: 520, y: 420}\n"
        "    angle: 90\n"
    )
    text = TABLE.read_text()
    TABLE.write_text(
        text[: text.index("  p2:")] + text[text.index("expect:") :]
        if "expect:" in text
        else text[: text.index("  p2:")]
    )
    assert pico("commit", "-m", "two files").code == 0
    pico("sim", "nudge", "p1", "--dx", "4")
    pico("sim", "nudge", "p2", "--dx", "4")
    answer = pico("capture", "p2.pose", "--dry-run")
    assert "Would write 1 tunable" in answer.out and "+    pose: {x: 524, y: 420}" in answer.out
    assert git("status", "--porcelain") == ""
    edit(TABLE, "exposure: 10", "exposure: 10   # ms")
    assert pico("commit", "-m", "p2 alone", "p2").code == 0
    assert git("show", "--name-only", "--format=").split() == ["state/hands.yaml"]
    assert git("status", "--porcelain").split() == ["M", "state/table.yaml"]
    assert pico("verify", "HEAD").code == 1, "p1 was left where it stands"
    assert trailer("Pico-Evidence") == ["planned"], "the bench did not stand so, for p1 had moved"
    assert pico("capture", "p1").code == 0
    assert pico("commit", "-m", "p1 as well").code == 0
    assert trailer("Pico-Evidence") == ["kinematic"]


def test_the_evidence_is_that_of_the_runs_that_led_there(shel: Path, pico: Pico) -> None:
    edit(shel / "lab.yaml", "sight: pixels", "sight: exact")  # quicker, and nothing here is about sight
    pico("apply", "--auto-approve", "--fidelity", "physics")
    pico("commit", "-m", "built")
    assert trailer("Pico-Evidence") == ["physics"] and len(trailer("Pico-Run")) == 1
    git("checkout", "-q", "-b", "other", "HEAD~1")
    edit(TABLE, "\n", "\n# the bench stands so by the run in physics, which another branch has\n")
    assert pico("commit", "-m", "words").code == 0
    git("checkout", "-q", "main")
    pico("set", "p1", "angle=3", "-y")
    pico("set", "p1", "angle=90", "--fidelity", "physics", "-y")
    edit(TABLE, "exposure: 10", "exposure: 12")
    pico("apply", "--auto-approve", "--fidelity", "physics")
    assert pico("commit", "-m", "set in physics").code == 0
    assert trailer("Pico-Evidence") == ["physics"]
    pico("sim", "nudge", "p2", "--dx", "5")
    edit(TABLE, "exposure: 12", "exposure: 14")
    pico("apply", "--auto-approve", "--fidelity", "physics", "--", "cam")
    assert pico("commit", "-m", "by hand, too").code == 0
    assert trailer("Pico-Evidence") == ["kinematic"], "nobody knows better than what looked"


def test_an_edit_of_what_nobody_sees_was_never_applied(built: Path, pico: Pico) -> None:
    pico("sim", "remove", "p2")
    edit(TABLE, P2, "      x: 505\n")
    refused = pico("commit", "-m", "move p2")
    assert refused.code == 1 and "never applied: p2 (missing)" in refused.err
    assert pico("commit", "-m", "move p2", "--planned").code == 0
    assert trailer("Pico-Evidence") == ["planned"] and trailer("Pico-Run") == []


def test_a_commit_carries_its_runs_once_and_leaves_the_rest_alone(built: Path, pico: Pico) -> None:
    (built / "elsewhere.txt").write_text("mine\n")
    (built / "staged.txt").write_text("mine, too\n")
    git("add", "staged.txt")
    pico("set", "p1", "angle=3", "-y")
    answer = pico("commit", "-m", "three degrees")
    assert "With 1 run (kinematic, sim)" in answer.out
    (run,) = trailer("Pico-Run")
    files = git("show", "--name-only", "--format=").split()
    assert [f for f in files if not f.startswith("runs/")] == ["state/table.yaml"]
    assert sorted(Path(f).name for f in files if run in f) == ["measurements.jsonl", "run.json", "trace.jsonl"]
    assert git("status", "--porcelain").splitlines() == ["A  staged.txt", "?? elsewhere.txt"]


def test_notes_are_carried_along_and_can_be_committed_alone(built: Path, pico: Pico) -> None:
    assert "Nothing was noted" in pico("note", "p2").out
    assert pico("note", "p2", "scratched", "at the rim").code == 0
    assert pico("commit").code == 0
    assert git("show", "--name-only", "--format=").split() == ["notes/p2.md"]
    assert body().startswith("Nothing on the table changed: notes\n")
    (note,) = pico("note", "p2", "--json").data["notes"]
    assert note["text"] == "scratched at the rim" and note["author"] == "A Physicist"
    assert pico("note", "p2", " ").code == 1


def test_a_lab_in_a_folder_of_a_repository_is_committed_from_anywhere(
    tmp_path: Path, shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    top = tmp_path / "top"
    (top / "docs").mkdir(parents=True)
    shutil.copytree(shel, top / "labs" / "shel", ignore=shutil.ignore_patterns(".git"))
    monkeypatch.chdir(top / "docs")
    git("init", "-q", "-b", "main", "..")
    git("add", "..")
    git("commit", "-q", "-m", "all of it")
    lab = ("-C", "../labs/shel")
    assert pico(*lab, "apply", "--auto-approve").code == 0
    pico(*lab, "sim", "nudge", "p2", "--dx", "5")
    pico(*lab, "note", "p2", "shoved")
    assert pico(*lab, "commit", "p2").code == 0
    files = git("show", "--name-only", "--format=").split()
    assert [f for f in files if "/runs/" not in f] == ["labs/shel/notes/p2.md", "labs/shel/state/table.yaml"]
    assert sum(f.endswith("run.json") for f in files) == 1
    assert body().startswith("p2 moved 5 mm\n")
    assert git("status", "--porcelain") == ""


def test_a_detached_head_commits_and_warns(built: Path, pico: Pico) -> None:
    git("checkout", "-q", "--detach")
    pico("sim", "nudge", "p2", "--dx", "5")
    answer = pico("commit", "-m", "off the road")
    assert answer.code == 0 and "`git switch -c NAME`" in answer.out
    assert "error[nothing-to-commit]" in pico("commit", "-e").err


def test_it_ends_a_merge_whose_conflicts_are_resolved(built: Path, pico: Pico) -> None:
    git("checkout", "-q", "-b", "other")
    edit(TABLE, P2, "      x: 505\n")
    git("commit", "-qam", "theirs")
    git("checkout", "-q", "main")
    edit(TABLE, P2, "      x: 540\n")
    git("commit", "-qam", "ours")
    git("merge", "-q", "other", ok=False)
    marked = pico("commit", "-m", "x")
    assert marked.code == 1 and "error[merge-conflict]" in marked.err and "--> state/table.yaml:" in marked.err
    git("checkout", "-q", "--theirs", "state/table.yaml")
    unresolved = pico("commit", "-m", "x")
    assert unresolved.code == 1 and "error[merge-conflict]" in unresolved.err and "`git add`" in unresolved.err
    git("add", "state/table.yaml")
    answer = pico("commit")
    assert answer.code == 0, answer.err
    assert len(git("show", "-s", "--format=%P").split()) == 2
    assert body().startswith("Merge branch 'other'\n\nPico-State: ")
    assert trailer("Pico-Evidence") == ["planned"]
    (built / ".git" / "MERGE_HEAD").write_text(git("rev-parse", "other"))  # a git that was killed just then
    assert pico("note", "p2", "x").code == 0
    assert pico("commit", "-m", "a note", "--planned").code == 0
    assert len(git("show", "-s", "--format=%P").split()) == 1


def test_a_rebase_is_gits_to_go_on_with(built: Path, pico: Pico) -> None:
    edit(TABLE, P2, "      x: 505\n")
    git("commit", "-qam", "an edit")
    subprocess.run(
        ["git", "-c", "sequence.editor=sed -i s/pick/edit/", "rebase", "-qi", "HEAD^"], check=True, capture_output=True
    )
    answer = pico("commit", "-m", "x", "--planned")
    assert answer.code == 1 and "error[git-rebasing]" in answer.err and "git rebase --continue" in answer.err


def test_a_hook_that_refuses_leaves_what_was_captured_as_an_edit(built: Path, pico: Pico) -> None:
    hook = built / ".git" / "hooks" / "pre-commit"
    hook.parent.mkdir(exist_ok=True)
    hook.write_text("#!/bin/sh\necho 'laser still on' >&2\nexit 1\n")
    hook.chmod(0o755)
    pico("set", "p1", "angle=3", "-y")
    answer = pico("commit", "-m", "x")
    assert answer.code == 1 and "error[git-hook]" in answer.err and "laser still on" in answer.err
    assert git("status", "--porcelain", "--", "state").split() == ["M", "state/table.yaml"]
    hook.unlink()
    assert pico("commit", "-m", "x").code == 0
    assert git("status", "--porcelain") == ""
    assert len(trailer("Pico-Run")) == 1


def test_the_first_commit_of_a_new_lab_takes_along_what_git_has_to_know(
    tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert pico("init", "mine").code == 0
    monkeypatch.chdir(tmp_path / "mine")
    assert pico("commit", "--planned", "-m", "first state").code == 0
    assert {".gitattributes", ".gitignore"} <= set(git("ls-files").split())
    (tmp_path / "mine" / ".gitignore").write_text("own\n")
    assert pico("commit", "--planned").code == 1  # a later edit of it is for git alone


def test_a_bench_that_stood_as_the_last_commit_and_was_brought_elsewhere_is_committed(shel: Path, pico: Pico) -> None:
    assert pico("apply", "--auto-approve").code == 0
    assert "is verified" in pico("verify").out
    assert pico("apply", "e1", "--auto-approve").code == 0
    answer = pico("commit", "-m", "try")
    assert answer.code == 0 and "p1.angle 90 → 1 deg" in " ".join(answer.out.split())
    assert pico("status", "--json").data["cut_short"] == []
    assert "No drift" in pico("drift").out


def test_a_clone_whose_bench_was_never_used_does_not_commit_over_what_another_bench_proved(
    shel: Path, pico: Pico, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert pico("apply", "--auto-approve").code == pico("set", "p1", "angle=33", "-y").code == 0
    assert pico("commit", "-m", "proven here").code == 0
    subprocess.run(["git", "clone", "-q", str(shel), str(tmp_path / "clone")], check=True)
    monkeypatch.chdir(tmp_path / "clone")
    answer = pico("commit", "-m", "over")
    assert answer.code == 1 and "the last commit was never applied to this bench" in answer.err
    assert pico("apply", "--auto-approve").code == 0
    assert pico("sim", "nudge", "p2", "--dx", "3").code == 0
    assert pico("commit", "-m", "a hand did it").code == 0


def test_the_first_commit_of_a_lab_takes_what_set_did_and_refuses_an_edit(
    tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert pico("init", ".").code == 0 and pico("apply", "--yes").code == 0
    assert pico("set", "camera", "exposure=6", "--yes").code == 0
    edit(tmp_path / "state" / "table.yaml", "slot: storage/a2", "slot: storage/a1")
    refused = pico("commit", "-m", "first")
    assert refused.code == 1 and "edits that were never applied: lens" in refused.err
    edit(tmp_path / "state" / "table.yaml", "slot: storage/a1", "slot: storage/a2")
    made = pico("commit", "-m", "first")
    assert made.code == 0 and "1 tunable taken from the bench" in made.out
