"""Going back, in whole and in part: checkout of components, revert, cherry-pick and stash, as a person types them."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico, Typed, edit

TABLE = Path("state/table.yaml")


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True).stdout


def dirty() -> str:
    return git("status", "--porcelain", "-uno")


def test_one_component_is_taken_from_a_revision_and_moved_and_brought_back(shel: Path, pico: Pico) -> None:
    pico("apply", "--auto-approve")
    answer = pico("checkout", "e1", "--auto-approve", "--", "p2")
    assert answer.code == 0, answer
    assert " → part of e1 (E1-3 " in answer.out and "p2  turned +30°" in answer.out
    assert git("diff", "-U0").splitlines()[-2:] == ["-      yaw: 0", "+      yaw: 30"]
    assert pico("get", "p2", "--json").data["values"]["pose"]["value"]["yaw"] == pytest.approx(30)
    assert "`pico checkout HEAD -- p2`" in answer.out
    assert pico("checkout", "HEAD", "--auto-approve", "--", "p2").code == 0
    assert not dirty() and pico("plan", "--detailed-exitcode").code == 0


def test_a_component_that_the_revision_does_not_have_goes_home(shel: Path, pico: Pico) -> None:
    text = TABLE.read_text()
    TABLE.write_text(text[: text.index("  p2:")])
    git("commit", "-q", "-a", "-m", "without p2")
    git("tag", "without")
    TABLE.write_text(text + "# the end\n")
    git("commit", "-q", "-a", "-m", "with p2")
    pico("checkout", "without", "--files-only", "--", "p2")
    assert "p2:" not in TABLE.read_text() and "# the end" in TABLE.read_text()
    git("commit", "-q", "-a", "-m", "p2 away")
    assert pico("checkout", "HEAD~1", "--files-only", "--", "p2.angle").code == 0
    assert "  p2:\n    slot: storage/b2\n    angle: 90\n" in TABLE.read_text()


def test_a_component_comes_back_into_the_file_that_the_revision_has_it_in(shel: Path, pico: Pico) -> None:
    other = Path("state/extra.yaml")
    text = TABLE.read_text()
    head, name, part = text.partition("  p2:\n")
    start = "apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents:\n"
    TABLE.write_text(head)
    other.write_text(f"{start}{name}{part}")
    git("add", "-A")
    git("commit", "-q", "-m", "two files")
    other.write_text(f"{start}  # nobody here\n")
    git("commit", "-q", "-a", "-m", "p2 away")
    answer = pico("checkout", "HEAD~1", "--files-only", "--json", "--", "p2")
    assert answer.data["files"] == ["state/extra.yaml"] and answer.data["schema"] == "pico.checkout/v1"
    assert "  p2:\n    pose:\n      x: 520" in other.read_text() and "# nobody here" in other.read_text()
    assert git("diff", "--name-only") == "state/extra.yaml\n"


def test_parts_that_the_bench_has_no_more_are_in_nobodys_way(shel: Path, pico: Pico) -> None:
    edit(Path("lab.yaml"), "  lx_125:\n    type: plano_convex_125\n    marker: 5\n    home: storage/a3\n", "")
    edit(TABLE, "  lx_125:\n    slot: storage/a3\n", "")
    git("commit", "-q", "-a", "-m", "lx_125 broke")
    assert pico("plan", "e1").code == 1
    answer = pico("apply", "e1", "--auto-approve", "--", "p2")
    assert answer.code == 0 and "only p2" in answer.out and "error" not in answer.err
    assert pico("checkout", "e1", "--files-only", "--", "p2").code == 0 and "yaw: 30" in TABLE.read_text()
    assert "no component `lx_125`" in pico("plan", "e1", "--", "lx_125").err


def test_one_tunable_is_taken_and_comments_stay(shel: Path, pico: Pico) -> None:
    edit(TABLE, "    angle: 90\n", "    angle: 90.0  # crossed\n")
    edit(TABLE, "exposure: 10", "exposure: 11")
    git("commit", "-q", "-a", "-m", "remarks")
    edit(TABLE, "exposure: 11", "exposure: 12")
    answer = pico("checkout", "e1", "--files-only", "--", "p1.angle")
    assert answer.code == 0 and "nothing moved" in answer.out.lower()
    assert "    angle: 1.0  # crossed\n" in TABLE.read_text() and "exposure: 12" in TABLE.read_text()


def test_edits_of_the_same_tunables_are_not_overwritten(shel: Path, pico: Pico) -> None:
    edit(TABLE, "      x: 520", "      x: 530")
    before = TABLE.read_text()
    answer = pico("checkout", "e1", "--auto-approve", "--", "p2")
    assert answer.code == 1 and "p2.pose was edited" in answer.err and "moved 10 mm" in answer.err
    assert TABLE.read_text() == before
    assert pico("checkout", "e1", "--files-only", "--", "p2.angle", "p1").code == 0


def test_what_does_not_fit_the_rest_of_the_manifest_is_refused(shel: Path, pico: Pico) -> None:
    pico("checkout", "e2", "--files-only")
    answer = pico("checkout", "e3", "--files-only", "--", "ly_200")
    assert answer.code == 3 and "ly_150" in answer.err and "ly_200" in answer.err and not dirty()
    assert pico("checkout", "e3", "--files-only", "--", "ly_200", "ly_150").code == 0


def test_a_whole_checkout_may_leave_the_bench_alone_and_says_how_to_go_back(shel: Path, pico: Pico) -> None:
    before = pico("get", "p2", "--json").data
    answer = pico("checkout", "e1", "--files-only")
    assert answer.code == 0 and "`pico checkout main --files-only`" in answer.out
    assert git("branch", "--show-current") == "e1\n" and pico("get", "p2", "--json").data == before
    assert "Go back with `pico checkout e1`" in pico("checkout", "main", "--auto-approve").out
    assert "Go back" not in pico("checkout", "main", "--auto-approve").out
    edit(TABLE, "exposure: 10", "exposure: 12")
    assert pico("checkout", "e1", "--files-only").code == 1


def test_a_declined_partial_checkout_writes_nothing(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    answer = pico("checkout", "e1", "--", "p2")
    assert answer.code == 1 and "Nothing moved" in answer.out and not dirty()


def test_a_revert_is_shown_and_says_how_to_go_back(shel: Path, pico: Pico) -> None:
    pico("checkout", "e1", "--files-only")
    answer = pico("revert", "E1-3", "-m", "too steep")
    assert answer.code == 0, answer
    assert answer.out.startswith('Took back E1-3 "tilt of p2') and "p1.angle  1 → 90 deg" in answer.out
    assert "nothing moved" in answer.out and "Go back with `pico revert HEAD`." in answer.out
    assert git("show", "-s", "--format=%s") == "too steep\n"
    again = pico("revert", "E1-3")
    assert again.code == 0 and "nothing of it to take back" in again.out
    assert pico("revert", "HEAD", "--json").data["carried"][0]["way"] == "revert"


def test_a_revert_that_is_not_committed_says_how_to_drop_it(shel: Path, pico: Pico) -> None:
    pico("checkout", "e1", "--files-only")
    answer = pico("revert", "E1-3", "--no-commit")
    assert "`git restore state/table.yaml`" in answer.out and dirty() == " M state/table.yaml\n"
    assert pico("commit", "--planned", "-m", "back").code == 0


def test_a_refused_revert_names_the_tunable_and_the_way_out_works(shel: Path, pico: Pico) -> None:
    pico("checkout", "e1", "--files-only")
    edit(TABLE, "    angle: 1\n", "    angle: 7\n")
    git("commit", "-q", "-a", "-m", "finer")
    answer = pico("revert", "E1-3")
    assert answer.code == 1 and "p1.angle: E1-3" in answer.err and '"finer" since then 7' in answer.err
    way_out = answer.err.partition("`pico ")[2].partition("`")[0].split()
    assert pico(*way_out[:2], "--files-only", *way_out[2:]).code == 0
    assert "    angle: 90\n" in TABLE.read_text()


def test_a_number_is_no_message(shel: Path, pico: Pico) -> None:
    answer = pico("revert", "HEAD", "-m", "1")
    assert answer.code == 1 and "`--mainline 1`" in answer.err


def test_a_cherry_pick_brings_changes_here(shel: Path, pico: Pico) -> None:
    answer = pico("cherry-pick", "E1-1", "E1-3")
    assert answer.code == 0, answer
    assert answer.out.count("Picked E1-") == 2 and "lx_125  placed at (395, 420, 0°)" in answer.out
    back = answer.out.partition("`git reset --keep ")[2].partition("`")[0]
    assert git("rev-parse", "--short", "main~2").startswith(back)
    assert "this state has that already" in pico("cherry-pick", "E1-3").out
    assert pico("cherry-pick", "E1-2", "--json").data["schema"] == "pico.carried/v1"
    refused = pico("cherry-pick", "E3-1")
    assert refused.code == 3 and "ly_200" in refused.err and "ly_150" in refused.err


def test_the_stash_says_that_the_bench_is_not_shelved(shel: Path, pico: Pico) -> None:
    edit(TABLE, "      x: 520", "      x: 530")
    pico("apply", "--auto-approve")
    answer = pico("stash")
    assert answer.code == 0 and not dirty()
    assert "p2  moved 10 mm" in answer.out and "the bench is not: nothing moved" in answer.out
    assert "1 of 9 components differs from the manifest" in answer.out and "`pico stash pop`" in answer.out
    assert pico("stash", "list").out == "0  On main: p2 moved 10 mm (dx +10)\n"
    back = pico("stash", "pop", "--json").data
    assert back["apart"] == 0 and back["shelves"][0]["changes"][0]["component"] == "p2"
    assert "x: 530" in TABLE.read_text()


def test_new_files_are_shelved_and_others_are_not(shel: Path, pico: Pico) -> None:
    Path("notebook.txt").write_text("other work")
    Path("state/extra.yaml").write_text("apiVersion: pico/v1\nkind: LabState\nmetadata: {lab: shel}\ncomponents: {}\n")
    assert pico("stash", "push", "-m", "a file").code == 0
    assert not Path("state/extra.yaml").exists() and Path("notebook.txt").exists()
    assert pico("stash").out.startswith("Nothing to shelve")
    assert pico("stash", "pop").code == 0 and Path("state/extra.yaml").exists()


def test_shelved_edits_unite_with_later_ones_or_are_named(shel: Path, pico: Pico) -> None:
    edit(TABLE, "      x: 520", "      x: 530")
    pico("stash", "-m", "right")
    edit(TABLE, "      y: 420\n      yaw: 0\n    angle: 90\n", "      y: 420\n      yaw: 0\n    angle: 45\n")
    git("commit", "-q", "-a", "-m", "turned")
    assert pico("stash", "pop").code == 0 and "x: 530" in TABLE.read_text() and "angle: 45" in TABLE.read_text()
    pico("stash", "-m", "right")
    edit(TABLE, "      x: 520", "      x: 510")
    git("commit", "-q", "-a", "-m", "left")
    answer = pico("stash", "pop")
    assert answer.code == 1 and "p2.pose.x: the shelved edits say 530 (+10), main says 510 (-10)" in answer.err
    assert not dirty() and "right" in pico("stash", "list").out


def test_shelved_edits_unite_by_value_where_plain_git_would_not(shel: Path, pico: Pico) -> None:
    pico("git", "uninstall")
    edit(TABLE, "      x: 520\n      y: 420", "      x: 530\n      y: 420")
    pico("stash")
    edit(TABLE, "      x: 520\n      y: 420", "      x: 520\n      y: 421")
    git("commit", "-q", "-a", "-m", "neighbor")
    assert pico("stash", "pop").code == 0 and "      x: 530\n      y: 421" in TABLE.read_text()


def test_dropped_edits_can_be_had_again(shel: Path, pico: Pico) -> None:
    edit(TABLE, "      x: 520", "      x: 530")
    pico("stash")
    answer = pico("stash", "drop")
    assert pico("stash", "list").out == "Nothing is shelved.\n"
    subprocess.run(answer.out.partition("`")[2].partition("`")[0], shell=True, check=True)
    assert pico("stash", "pop").code == 0 and "x: 530" in TABLE.read_text()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["stash", "pul"], "action can't be `pul`"),
        (["stash", "pop"], "nothing is shelved"),
        (["checkout", "e1", "--", "p3"], "no component `p3`"),
        (["checkout", "e9", "--", "p2"], "no revision `e9`"),
        (["revert", "e9"], "no revision `e9`"),
        (["cherry-pick", "main..e9"], "no revision `e9`"),
        (["revert", "C1"], "C1 is the first commit"),
        (["revert", "HEAD", "--mainline", "2"], "is no merge"),
    ],
)
def test_mistakes_are_told(shel: Path, pico: Pico, words: list[str], said: str) -> None:
    answer = pico(*words)
    assert answer.code == 1 and said in answer.err and "Traceback" not in answer.err
