"""A name of a revision means one thing for the bench and for the files, or it is refused."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico


def git(folder: Path, *words: str) -> str:
    return subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=True).stdout.strip()


@pytest.fixture
def both(shel: Path) -> Path:
    """The example with a tag `e1` at E2-3 beside its branch `e1`, which is at E1-3."""
    git(shel, "tag", "e1", "E2-3")
    return shel


READERS = (
    ("plan", "e1"),
    ("apply", "e1", "--auto-approve"),
    ("checkout", "e1", "--auto-approve"),
    ("checkout", "e1", "--files-only"),
    ("checkout", "e1", "--files-only", "--", "p2"),
    ("diff", "e1"),
    ("diff", "C3..e1"),
    ("show", "e1"),
    ("show", "e1~1"),
    ("log", "e1"),
    ("blame", "p1", "--at", "e1"),
    ("bisect", "start", "e1", "C1"),
    ("merge", "e1"),
    ("revert", "e1"),
    ("cherry-pick", "C3..e1"),
    ("runs", "list", "e1"),
    ("check", "e1"),
)


@pytest.mark.parametrize("words", READERS, ids=" ".join)
def test_a_name_that_is_a_tag_and_a_branch_is_refused(words: tuple[str, ...], both: Path, pico: Pico) -> None:
    before = git(both, "status", "--porcelain", "--branch")
    answer = pico(*words)
    assert answer.code == 1 and "error[ambiguous]" in answer.err, answer.err
    for form in ("tags/e1", "heads/e1"):
        assert form in answer.err
    assert git(both, "status", "--porcelain", "--branch") == before


def test_the_unambiguous_forms_lead_bench_and_files_to_one_commit(both: Path, pico: Pico) -> None:
    assert "ly_150" in pico("plan", "heads/e1").out
    assert pico("checkout", "heads/e1", "--files-only").code == 0
    assert git(both, "symbolic-ref", "HEAD") == "refs/heads/e1"
    assert git(both, "rev-parse", "HEAD") == git(both, "rev-parse", "E1-3")
    back = pico("checkout", "tags/e1", "--files-only")
    assert git(both, "rev-parse", "HEAD") == git(both, "rev-parse", "E2-3")
    assert "pico checkout heads/e1" in back.out, "the way back is unambiguous, too"


def test_a_tag_and_a_branch_at_one_commit_mean_the_same(shel: Path, pico: Pico) -> None:
    git(shel, "tag", "e2", "E2-3")
    assert pico("plan", "e2").code in (0, 2)


def test_the_branch_step_of_a_recipe_takes_its_branch_though_a_tag_has_the_name(both: Path) -> None:
    from pico.history.repository.repository import Repository

    repository = Repository.discover(both)
    assert repository is not None
    repository.checkout("refs/heads/e1")
    assert repository.head().branch == "e1"


def test_python_refuses_an_ambiguous_name(both: Path) -> None:
    import pico as library
    from pico.diagnostics import PicoError

    with library.open(both) as bench, pytest.raises(PicoError, match="heads/e1"):
        bench.plan("e1")


@pytest.fixture
def clone(shel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A clone of the example, at C3, with a second remote that has the same branches."""
    folder = tmp_path / "clone"
    git(tmp_path, "clone", "-q", str(shel), str(folder))
    git(tmp_path, "clone", "-q", "--bare", str(shel), "second.git")
    git(folder, "remote", "add", "second", str(tmp_path / "second.git"))
    git(folder, "fetch", "-q", "second")
    monkeypatch.chdir(folder)
    return folder


def test_a_branch_that_two_remotes_have_at_one_commit_is_planned_and_named(clone: Path, pico: Pico) -> None:
    assert "→ origin/e2 (E2-3" in pico("plan", "e2").out
    refused = pico("checkout", "e2", "--files-only")
    assert refused.code == 1 and "origin/e2" in refused.err and "second/e2" in refused.err


def test_a_branch_that_two_remotes_have_at_different_commits_is_refused(clone: Path, pico: Pico) -> None:
    git(clone, "update-ref", "refs/remotes/second/e2", git(clone, "rev-parse", "E1-3"))
    refused = pico("plan", "e2")
    assert refused.code == 1 and "error[ambiguous]" in refused.err
    assert "origin/e2" in refused.err and "second/e2" in refused.err and "checkout.defaultRemote" in refused.err


def test_the_default_remote_decides_as_for_git(clone: Path, pico: Pico) -> None:
    git(clone, "update-ref", "refs/remotes/second/e2", git(clone, "rev-parse", "E1-3"))
    git(clone, "config", "checkout.defaultRemote", "second")
    assert "→ second/e2 (E1-3" in pico("plan", "e2").out
    assert pico("checkout", "e2", "--files-only").code == 0
    assert git(clone, "rev-parse", "HEAD") == git(clone, "rev-parse", "E1-3")
    assert git(clone, "rev-parse", "--abbrev-ref", "e2@{upstream}") == "second/e2"


def test_a_branch_that_one_of_two_remotes_has_is_taken(clone: Path, pico: Pico) -> None:
    git(clone, "update-ref", "-d", "refs/remotes/second/e2")
    assert "→ origin/e2 (E2-3" in pico("plan", "e2").out
    assert pico("checkout", "e2", "--files-only").code == 0
    assert git(clone, "rev-parse", "--abbrev-ref", "HEAD") == "e2"


EMPTY = (
    ("plan", ""), ("apply", "", "-y"), ("checkout", "", "-y"), ("show", ""), ("verify", ""), ("log", ""), ("diff", ""),
    ("diff", "HEAD", ""), ("check", ""), ("runs", "list", ""), ("merge", ""), ("revert", ""), ("plan", "  "),
)  # fmt: skip


@pytest.mark.parametrize("words", EMPTY)
def test_an_empty_word_is_no_revision(shel: Path, pico: Pico, words: tuple[str, ...]) -> None:
    """As `pico plan "$BRANCH"` of a shell in which BRANCH is not set."""
    refused = pico(*words)
    assert refused.code == 1 and "an empty word names no revision" in refused.err, refused
    assert not refused.out and not (shel / ".pico/benches").exists()
