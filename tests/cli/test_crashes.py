"""Killed at any instant, a checkout or a merge leaves a sound repository, and the next command works."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from killed_commands import duration, git, instants, killed, require_whole

CHECKOUT = ("checkout", "e2", "--auto-approve")
FILES = ("checkout", "e2", "--files-only")
MERGE = ("merge", "theirs", "-m", "both")


def prepared(shel: Path) -> Path:
    """The example at e1, with a branch that says another place of one part and one of another."""
    table = shel / "state/table.yaml"
    git(shel, "checkout", "-q", "-b", "ours", "e1")
    git(shel, "checkout", "-q", "-b", "theirs")
    table.write_text(table.read_text().replace("exposure: 10", "exposure: 8"))
    git(shel, "commit", "-q", "-a", "-m", "shorter")
    git(shel, "checkout", "-q", "ours")
    (shel / "notes").mkdir()
    (shel / "notes/p2.md").write_text("- 2026-01-01 A: clean\n")
    git(shel, "add", "-A")
    git(shel, "commit", "-q", "-m", "a note")
    return shel


def crash(shel: Path, words: tuple[str, ...], count: int, seed: int, *, again: bool) -> int:
    """Kill a command `count` times, each in a copy; return how often it was killed before its end.

    `again`: what was killed is done again afterwards, and then comes to its end.
    """
    origin = prepared(shel)
    names = ("ours", "e2") if words[0] == "checkout" else ("ours",)
    allowed = {git(origin, "rev-parse", f"{name}^0") for name in names}
    trial = origin.parent / "trial"
    shutil.copytree(origin, trial)
    longest = duration(trial, words)
    hit = 0
    for instant in instants(count, longest, seed):
        shutil.rmtree(trial)
        shutil.copytree(origin, trial)
        hit += killed(trial, words, instant)
        require_whole(trial, allowed)
        for lock in trial.glob(".git/**/*.lock"):
            if lock.name in ("index.lock", "HEAD.lock") or "refs" in lock.parts:
                lock.unlink()  # of the git that was killed: PICO's message names it
        if (trial / ".git/MERGE_HEAD").exists():
            git(trial, "merge", "--abort")
        assert not killed(trial, ("plan",), 120.0)
        if again:
            git(trial, "checkout", "-q", "-f", "ours")
            assert not killed(trial, words, 120.0)
            require_whole(trial, allowed)
    return hit


@pytest.mark.parametrize("words", [FILES, MERGE], ids=["checkout", "merge"])
def test_killed_once(shel: Path, words: tuple[str, ...]) -> None:
    crash(shel, words, 1, seed=1, again=False)  # asserts of what is left; the instant may come too late


@pytest.mark.slow
@pytest.mark.parametrize("words", [CHECKOUT, FILES, MERGE], ids=["checkout", "files", "merge"])
def test_killed_often(shel: Path, words: tuple[str, ...]) -> None:
    assert crash(shel, words, 20, seed=2, again=True) >= 5
