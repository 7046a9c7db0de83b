"""A commit that is killed, that waits for others, and that hooks change: index and HEAD always agree on what is new."""

from __future__ import annotations

import os
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from commit_steps import forked, kill_at

from pico.diagnostics import PicoError
from pico.history.repository.repository import Repository
from pico.history.writing.lock import write_lock

Git = Callable[..., str]
FILE = "state/table.yaml"


def opened(root: Path) -> Repository:
    found = Repository.discover(root)
    assert found is not None
    return found


def write(root: Path, text: str) -> None:
    (root / FILE).write_text(text)


def hook(root: Path, name: str, script: str) -> None:
    path = root / ".git" / "hooks" / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


def clean(root: Path, git: Git) -> None:
    """Demand that nothing lies about and that git finds everything in order."""
    assert git("status", "--porcelain") == ""
    assert "error" not in git("fsck", "--strict", "--no-dangling")
    assert [p.name for p in (root / ".git").rglob("*.lock")] == ["write.lock"]


def never_reversed(root: Path, git: Git, before: str, old: str, new: str) -> None:
    """Demand that HEAD is the old commit or one on it, and that index and file are not older than HEAD."""
    texts = [git("show", f"HEAD:{FILE}"), git("show", f":{FILE}"), (root / FILE).read_text()]
    ages = [(old, new).index(text) for text in texts]
    assert ages == sorted(ages), ages
    head = git("rev-parse", "HEAD").strip()
    assert head == before or git("rev-parse", "HEAD^").strip() == before


@pytest.mark.parametrize("after", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_killed_at_any_step_nothing_is_lost_or_reversed(repo: Path, git: Git, after: bool) -> None:
    step, ended = 0, False
    while not ended:
        step += 1
        old, new = (repo / FILE).read_text(), f"x: {100 + step}\n"
        before = git("rev-parse", "HEAD").strip()

        def work(new: str = new, step: int = step) -> None:
            kill_at(step, after=after)
            write(repo, new)
            opened(repo).commit([FILE], f"step {step}")

        ended = forked(work)
        assert step < 100
        if (repo / FILE).read_text() == old:
            write(repo, new)
        never_reversed(repo, git, before, old, new)
        if git("rev-parse", "HEAD").strip() == before:
            assert opened(repo).commit([FILE], "again").summary == "again"
        else:
            with opened(repo).writing("a look"):
                pass
        assert git("show", f"HEAD:{FILE}") == new
        clean(repo, git)
    assert step > 10


@pytest.mark.parametrize(
    "name", ["pre-commit", "prepare-commit-msg", "commit-msg", "post-commit", "reference-transaction"]
)
def test_killed_inside_git_its_locks_are_known_and_cleared(repo: Path, git: Git, name: str) -> None:
    before = git("rev-parse", "HEAD").strip()
    hook(repo, name, "kill -9 0")
    write(repo, "x: 7\n")
    assert not forked(lambda: opened(repo).commit([FILE], "killed"))
    never_reversed(repo, git, before, "x: 1\n", "x: 7\n")
    (repo / ".git" / "hooks" / name).unlink()
    repository = opened(repo)
    with repository.writing("a look"):
        cleared = [d.summary for d in repository.noticed]
    assert any("index.lock" in text for text in cleared), cleared
    if name == "reference-transaction":
        assert any("refs/heads/main.lock" in text for text in cleared) and any("HEAD.lock" in text for text in cleared)
    if git("rev-parse", "HEAD").strip() == before:
        repository.commit([FILE], "again")
    clean(repo, git)


def test_a_ref_lock_of_somebody_else_is_left(repo: Path, git: Git, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pico.history.writing.locked_git._SAFE", ("-c", "core.filesRefLockTimeout=10"))
    hook(repo, "pre-commit", "kill -9 0")
    write(repo, "x: 7\n")
    assert not forked(lambda: opened(repo).commit([FILE], "killed"))
    (repo / ".git" / "hooks" / "pre-commit").unlink()
    lock = repo / ".git" / "refs" / "heads" / "main.lock"
    lock.write_text(git("rev-parse", "first"))  # what no commit of ours was to write
    with pytest.raises(PicoError) as caught:
        opened(repo).commit([FILE], "again")
    assert caught.value.diagnostics[0].code == "git-locked"
    assert lock.exists()


def test_while_a_git_of_a_killed_commit_lives_nobody_takes_its_lock(
    repo: Path, git: Git, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pico.history.writing.index_lock.WAIT", 0.05)
    go = repo / ".git" / "go"
    os.mkfifo(go)
    hook(repo, "pre-commit", f"kill -9 $(cat '{repo}/.git/parent'); cat '{go}' > /dev/null")
    write(repo, "x: 7\n")

    def work() -> None:
        (repo / ".git" / "parent").write_text(str(os.getpid()))
        opened(repo).commit([FILE], "the process dies, its git goes on")

    assert not forked(work)
    with pytest.raises(PicoError, match="still running") as caught:
        opened(repo).commit([FILE], "again")
    assert caught.value.diagnostics[0].code == "git-locked"
    go.write_text("go\n")
    monkeypatch.setattr("pico.history.writing.index_lock.WAIT", 10.0)
    repository = opened(repo)
    with repository.writing("a look"):
        assert git("log", "-1", "--format=%s").strip() == "the process dies, its git goes on"
    clean(repo, git)


def test_threads_of_commits_are_all_there(repo: Path, git: Git) -> None:
    def work(number: int) -> None:
        for turn in range(4):
            path = repo / "state" / f"own{number}.yaml"
            path.write_text(f"x: {turn}\n")
            opened(repo).commit([path], f"{number}: {turn}")

    workers = [threading.Thread(target=work, args=(n,)) for n in range(3)]
    for each in workers:
        each.start()
    for each in workers:
        each.join()
    subjects = git("log", "--format=%s", "-12").splitlines()
    assert sorted(subjects) == sorted(f"{n}: {t}" for n in range(3) for t in range(4))
    clean(repo, git)


def test_worktrees_share_the_lock_and_the_holder_is_named(repo: Path, git: Git) -> None:
    git("worktree", "add", "-q", "../other", "side")
    other = opened(repo.parent / "other")
    assert other.common == opened(repo).common and other.own != other.common
    path = other.common / "pico" / "write.lock"
    with (
        opened(repo).writing("pico commit"),
        pytest.raises(PicoError) as caught,
        write_lock(path, "another", seconds=0.02),
    ):
        pass
    (said,) = caught.value.diagnostics
    assert said.code == "write-locked" and f"process {os.getpid()}: pico commit" in said.summary
    (other.root / FILE).write_text("x: 8\n")
    assert other.commit([FILE], "in a worktree").summary == "in a worktree"
    assert git("status", "--porcelain", at="other") == ""


def test_what_a_hook_makes_of_a_file_is_committed_and_not_staged_as_its_reversal(repo: Path, git: Git) -> None:
    hook(repo, "pre-commit", f"echo '# formatted' >> {FILE} && git add {FILE}")
    write(repo, "x: 7\n")
    opened(repo).commit([FILE], "formatted")
    assert git("show", f"HEAD:{FILE}") == "x: 7\n# formatted\n"
    clean(repo, git)


def test_a_refused_commit_leaves_the_index_as_it_was(repo: Path, git: Git) -> None:
    hook(repo, "commit-msg", "echo no; exit 1")
    (repo / "lab.yaml").write_text("kind: Other\n")
    git("add", "lab.yaml")
    write(repo, "x: 7\n")
    before = git("status", "--porcelain")
    with pytest.raises(PicoError) as caught:
        opened(repo).commit([FILE], "why")
    assert "commit-msg" in caught.value.diagnostics[0].summary and caught.value.diagnostics[0].detail == "no"
    assert git("status", "--porcelain") == before


def test_staged_things_elsewhere_stay_staged_and_odd_names_stand_for_themselves(repo: Path, git: Git) -> None:
    (repo / "lab.yaml").write_text("kind: Other\n")
    git("add", "lab.yaml")
    (repo / "elsewhere.txt").write_text("dirty\n")
    for name in ("a*.yaml", "ab.yaml", ":(top)x.yaml", "é \t.yaml"):
        (repo / "state" / name).write_text("y: 1\n")
    opened(repo).commit(["state/a*.yaml", "state/:(top)x.yaml", "state/é \t.yaml"], "odd names")
    assert git("status", "--porcelain", "-z").split("\0")[:-1] == [
        "M  lab.yaml",
        "?? elsewhere.txt",
        "?? state/ab.yaml",
    ]
    (repo / "state" / "a*.yaml").unlink()
    opened(repo).commit(["state/a*.yaml"], "and away")
    assert "state/a*.yaml" not in git("ls-files", "-z").split("\0")


def test_an_ignored_file_is_committed_where_it_is_asked_for(repo: Path, git: Git) -> None:
    (repo / ".gitignore").write_text("runs/\n")
    path = repo / "runs" / "a" / "run.json"
    path.parent.mkdir(parents=True)
    path.write_text("{}")
    opened(repo).commit([], "a run", ignored=[path])
    assert git("show", "--name-only", "--format=").split() == ["runs/a/run.json"]


def test_author_and_dates_are_gits_and_the_same_commit_has_the_same_id(
    repo: Path, git: Git, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GIT_AUTHOR_DATE", "2026-03-04T05:06:07+02:00")
    monkeypatch.setenv("GIT_COMMITTER_DATE", "2026-03-04T05:06:08+02:00")
    monkeypatch.setenv("GIT_AUTHOR_NAME", "Somebody Else")
    ids = set()
    for _ in range(2):
        write(repo, "x: 7\n")
        ids.add(opened(repo).commit([FILE], "why\n\nPico-State: x").id)
        assert git("show", "-s", "--format=%an %aI %cI").strip() == (
            "Somebody Else 2026-03-04T05:06:07+02:00 2026-03-04T05:06:08+02:00"
        )
        git("reset", "-q", "--hard", "HEAD^")
    assert len(ids) == 1


def test_commits_are_signed_as_configured(repo: Path, git: Git, tmp_path: Path) -> None:
    key = tmp_path / "key"
    try:
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", key], check=True, capture_output=True)
    except FileNotFoundError:
        pytest.skip("no ssh-keygen here")
    (tmp_path / "allowed").write_text(f"physicist@localhost {(tmp_path / 'key.pub').read_text()}")
    for name, value in {
        "gpg.format": "ssh", "user.signingKey": str(key), "commit.gpgSign": "true",
        "gpg.ssh.allowedSignersFile": str(tmp_path / "allowed"),
    }.items():  # fmt: skip
        git("config", name, value)
    write(repo, "x: 7\n")
    opened(repo).commit([FILE], "signed")
    assert git("show", "-s", "--format=%G?").strip() == "G"
    key.unlink()
    write(repo, "x: 8\n")
    with pytest.raises(PicoError) as caught:
        opened(repo).commit([FILE], "not signed")
    assert caught.value.diagnostics[0].code == "git-signing"
