"""`pico merge`, `pico doctor` and `pico git`, as a person types them."""

from __future__ import annotations

import subprocess
from pathlib import Path

import forking
import pytest
from commanding import Pico, edit


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], check=True, capture_output=True, text=True).stdout


def commit(branch: str, *edits: tuple[str, str]) -> None:
    git("checkout", "-q", "-b", branch, "main")
    for before, after in edits:
        edit(Path("state/table.yaml"), before, after)
    git("commit", "-q", "-a", "-m", branch)


def test_a_merge_is_made_and_shown(shel: Path, pico: Pico) -> None:
    commit("left", ("x: 290", "x: 300"))
    commit("right", ("x: 520", "x: 530"))
    made = pico("merge", "left", "-m", "both moved")
    assert made.code == 0 and made.err == "shel · sim\n"
    assert made.out.startswith("Merged left (") and "p1  moved 10 mm" in made.out
    assert git("show", "-s", "--format=%s").strip() == "both moved"
    assert pico("merge", "left", "--json").data["kind"] == "up-to-date"


def test_what_a_killed_merge_left_is_told_by_the_next_command_and_the_merge_then_works(shel: Path, pico: Pico) -> None:
    commit("left", ("x: 290", "x: 300"))
    commit("right", ("x: 520", "x: 530"))
    hook = Path(".git/hooks/commit-msg")
    hook.parent.mkdir(exist_ok=True)
    hook.write_text("#!/bin/sh\nkill -9 $PPID\n")
    hook.chmod(0o755)
    assert forking.started(forking.PICO, "merge", "left").wait(60) == -9
    hook.unlink()
    said = pico("merge", "left")
    assert said.code == 0 and said.out.startswith("Merged left ("), said.err
    assert "took back what was half written by `pico merge left`, which was killed" in said.err
    assert pico("status").err == "shel · sim\n"


WORDS = (
    ["status"], ["plan"], ["log"], ["merge", "e1"], ["commit", "-m", "x"], ["revert", "HEAD"], ["cherry-pick", "e1"],
    ["stash"], ["checkout", "e1"], ["pull"], ["push"], ["check"], ["doctor"], ["validate"], ["blame"], ["show"],
    ["data", "status"], ["bisect", "log"], ["verify"],
)  # fmt: skip


@pytest.mark.parametrize("words", WORDS, ids=" ".join)
def test_a_bare_clone_is_called_one(shel: Path, pico: Pico, words: list[str]) -> None:
    git("clone", "-q", "--bare", ".", "../bare.git")
    answer = pico("-C", "../bare.git", *words)
    assert answer.code == 1 and "bare repository (a bare clone)" in answer.err and "git clone " in answer.err


@pytest.mark.parametrize(("mine", "code", "said"), [("x: 310", 1, "p1.pose.x"), ("x: 290", 3, "p2")])
def test_a_refused_merge_says_why_and_writes_nothing(shel: Path, pico: Pico, mine: str, code: int, said: str) -> None:
    commit("left", ("x: 290", "x: 300"))
    commit("right", ("x: 290", mine) if code == 1 else ("x: 520", "x: 320"))
    before = git("rev-parse", "HEAD")
    answer = pico("merge", "left")
    assert answer.code == code and "p1" in answer.err and said in answer.err
    assert git("rev-parse", "HEAD") == before and not git("status", "--porcelain", "-uno")


def test_parts_of_a_pose_from_both_sides_are_merged_with_a_warning(shel: Path, pico: Pico) -> None:
    commit("left", ("x: 290", "x: 300"))
    git("checkout", "-q", "-b", "right", "main")
    text = Path("state/table.yaml").read_text()
    head, name, tail = text.partition("  p1:\n")
    Path("state/table.yaml").write_text(head + name + tail.replace("yaw: 0", "yaw: 5", 1))
    git("commit", "-q", "-a", "-m", "right")
    answer = pico("merge", "left")
    assert answer.code == 0 and "warning[coupled]: p1: right changed pose.yaw, left pose.x" in answer.err


def test_the_driver_is_taken_out_set_and_checked(shel: Path, pico: Pico) -> None:
    assert pico("doctor").out.startswith("All is well")
    assert pico("git", "uninstall").code == 0
    assert "merge.pico" not in git("config", "--list", "--local")
    assert pico("status").err == "shel · sim\n" and "git-driver" in pico("doctor").err
    assert pico("git", "install").code == 0 and pico("doctor", "--json").data["well"]


@pytest.mark.parametrize("words", [["merge", "side"], ["cherry-pick", "side"]], ids=" ".join)
def test_a_split_index_is_named_with_the_way_out(shel: Path, pico: Pico, words: list[str]) -> None:
    commit("side", ("x: 520", "x: 530"))
    commit("here", ("x: 290", "x: 300"))
    git("config", "core.splitIndex", "true")
    git("update-index", "--split-index")
    answer = pico(*words)
    assert answer.code == 1 and "PICO itself failed" not in answer.err
    assert "core.splitIndex" in answer.err and "--no-split-index" in answer.err
    git("config", "core.splitIndex", "false")
    git("update-index", "--no-split-index")
    assert pico(*words).code == 0
