"""A shallow clone (`git clone --depth 1`): what it lacks is named with the command that fetches it, never guessed."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico


def git(*words: str, at: Path) -> str:
    return subprocess.run(["git", *words], cwd=at, check=True, capture_output=True, text=True).stdout.strip()


@pytest.fixture
def clone(shel: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The last commit of each branch of the example, e1 checked out."""
    at = tmp_path_factory.mktemp("shallow") / "shel"
    git("clone", "-q", "--depth=1", "--no-tags", "--no-single-branch", "--branch=e1", shel.as_uri(), str(at), at=shel)
    for name, value in (("user.name", "tester"), ("user.email", "tester@localhost")):
        git("config", name, value, at=at)
    monkeypatch.chdir(at)
    return at


@pytest.mark.parametrize(
    "words",
    [
        "revert HEAD", "revert HEAD~1", "revert origin/e2", "cherry-pick origin/e2", "cherry-pick HEAD~2..HEAD",
        "merge origin/e2", "checkout C2", "checkout HEAD~1", "checkout 'HEAD^'", "plan C1", "plan HEAD~1",
        "apply HEAD~1 --yes", "diff HEAD~1", "diff HEAD...origin/e2", "log C1..HEAD", "log HEAD~1", "show HEAD~1",
        "blame p1 --at C2", "bisect start HEAD C1", "bisect start origin/e2 HEAD", "verify HEAD~1", "check HEAD~1",
        "render HEAD~1", "beam HEAD~1",
    ],
)  # fmt: skip
def test_what_a_shallow_clone_lacks_is_one_error_with_the_command_that_fetches_it(
    clone: Path, pico: Pico, words: str
) -> None:
    before = git("rev-parse", "HEAD", at=clone)
    answer = pico(*words.replace("'", "").split())
    assert answer.code == 1, answer.out
    assert answer.err.count("error[") == 1 and "error[shallow]" in answer.err, answer.err
    assert "git fetch --unshallow" in answer.err and "--allow-unrelated-histories" not in answer.err
    assert "there is no revision" not in answer.err and "first commit" not in answer.err
    assert (git("rev-parse", "HEAD", at=clone), git("status", "--porcelain", at=clone)) == (before, "")


def test_the_last_commit_that_a_shallow_clone_has_is_not_called_the_first_state(clone: Path, pico: Pico) -> None:
    for words in (("log",), ("log", "--oneline"), ("show", "HEAD"), ("log", "--", "p1")):
        answer = pico(*words)
        said = " ".join(answer.out.split())
        assert answer.code == 0 and "lacks the commit before (`git fetch --unshallow --tags`)" in said, said
        assert "the first state" not in said and "from storage" not in said
    git("fetch", "-q", "--unshallow", "--tags", at=clone)
    assert "shallow" not in pico("log").out
    assert pico("revert", "HEAD").code == 0


def test_a_clone_of_a_single_branch_is_told_how_to_get_the_others(
    shel: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    at = tmp_path / "single"
    git("clone", "-q", "--depth=1", "--branch=e1", shel.as_uri(), str(at), at=shel)
    monkeypatch.chdir(at)
    answer = pico("merge", "origin/e2")
    command = "git remote set-branches origin '*' && git fetch --unshallow --tags"
    assert "error[shallow]" in answer.err and command in " ".join(answer.err.split())
    subprocess.run(command, shell=True, cwd=at, check=True, capture_output=True)
    assert "origin/e2" in pico("show", "origin/e2").out
