"""What changes a repository goes through the user's git: hooks, identity, locks, edits in the way."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from pico.diagnostics import PicoError
from pico.history.repository.repository import Repository

Git = Callable[..., str]


@pytest.fixture
def repository(repo: Path) -> Repository:
    found = Repository.discover(repo)
    assert found is not None
    return found


def edit(repository: Repository, text: str = "x: 9\n") -> None:
    (repository.root / "state" / "table.yaml").write_text(text)


def refused(repository: Repository, message: str = "why") -> PicoError:
    with pytest.raises(PicoError) as caught:
        repository.commit(["state/table.yaml"], message)
    return caught.value


def test_commit_takes_its_paths_and_nothing_else(repository: Repository, git: Git) -> None:
    edit(repository)
    (repository.root / "lab.yaml").write_text("kind: Other\n")
    git("add", "lab.yaml")
    (repository.root / "state" / "more.yaml").write_text("y: 1\n")
    commit = repository.commit(["state/table.yaml", "state/more.yaml"], "# not a comment\n\nlong")
    assert commit.summary == "# not a comment" and commit.id == git("rev-parse", "HEAD").strip()
    assert git("show", "--name-only", "--format=").split() == ["state/more.yaml", "state/table.yaml"]
    assert repository.changed() == ("lab.yaml",)


def test_without_an_identity_it_says_what_to_set(
    repository: Repository, git: Git, monkeypatch: pytest.MonkeyPatch
) -> None:
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.delenv(f"GIT_{who}_NAME")
        monkeypatch.delenv(f"GIT_{who}_EMAIL")
    git("config", "user.useConfigOnly", "true")
    edit(repository)
    (said,) = refused(repository).diagnostics
    assert said.code == "identity" and "user.name" in said.hint and "user.email" in said.hint


def test_a_hook_that_refuses_is_named_with_its_words(repository: Repository) -> None:
    hook = repository.root / ".git" / "hooks" / "pre-commit"
    hook.write_text("#!/bin/sh\necho 'laser still on' >&2\nexit 1\n")
    hook.chmod(0o755)
    edit(repository)
    (said,) = refused(repository).diagnostics
    assert said.code == "git-hook" and "pre-commit" in said.summary and said.detail == "laser still on"


def test_a_lock_of_somebody_else_is_named_and_left(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pico.history.writing.index_lock.WAIT", 0.05)
    lock = repository.root / ".git" / "index.lock"
    lock.touch()
    edit(repository)
    (said,) = refused(repository).diagnostics
    assert said.code == "git-locked" and str(lock) in said.summary and str(lock) in said.hint
    assert lock.exists()


def test_nothing_to_commit_and_no_message_are_said(repository: Repository) -> None:
    assert refused(repository).diagnostics[0].code == "nothing-to-commit"
    edit(repository)
    assert refused(repository, "  ").diagnostics[0].code == "message"


def test_checkout_goes_there_and_back(repository: Repository) -> None:
    assert repository.checkout("side").branch == "side"
    assert (repository.root / "state" / "table.yaml").read_text() == "x: 2\n"
    assert repository.checkout("first").branch is None
    assert repository.checkout("-").branch == "side"


def test_checkout_never_overwrites_an_edit(repository: Repository) -> None:
    edit(repository)
    with pytest.raises(PicoError) as caught:
        repository.checkout("side")
    (said,) = caught.value.diagnostics
    assert said.code == "dirty" and "state/table.yaml" in said.detail and "pico commit" in said.hint
    assert repository.head().branch == "main"


def test_branches_and_tags_are_made_once(repository: Repository) -> None:
    repository.branch("e1", "first")
    repository.tag("C1")
    assert repository.resolve("e1").id == repository.resolve("first").id
    assert repository.resolve("C1").id == repository.head().commit
    for again in (lambda: repository.branch("e1"), lambda: repository.tag("C1")):
        with pytest.raises(PicoError) as caught:
            again()
        assert caught.value.diagnostics[0].code == "exists"
    with pytest.raises(PicoError):
        repository.branch("-d")


def test_a_missing_git_is_said(repository: Repository, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    with pytest.raises(PicoError, match="no `git` command"):
        repository.changed()
