"""Commands in a partial clone: what is missing is fetched, a few times a command, or the clone is named as partial."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico

from pico.history.git import partial


def git(folder: Path, *words: str) -> str:
    return subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=True).stdout.strip()


@pytest.fixture
def server(shel: Path, tmp_path: Path) -> Path:
    git(tmp_path, "clone", "-q", "--bare", str(shel), "server.git")
    git(tmp_path / "server.git", "config", "uploadpack.allowFilter", "true")
    return tmp_path / "server.git"


@pytest.fixture(params=["blob:none", "tree:0"])
def clone(
    request: pytest.FixtureRequest, server: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> Path:
    git(tmp_path, "clone", "-q", f"--filter={request.param}", "--no-local", server.as_uri(), "clone")
    monkeypatch.chdir(tmp_path / "clone")
    return tmp_path / "clone"


@pytest.fixture
def fetches(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many objects each fetch asked for."""
    found: list[int] = []
    real = partial.git.run

    def run(root: Path, arguments: list[str], **options: object) -> str:
        if "fetch" in arguments:
            found.append(str(options["stdin"]).count("\n"))
        return real(root, arguments, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(partial.git, "run", run)
    return found


COMMANDS = (
    ("log", "--all", "--oneline"),
    ("log", "origin/e1", "--", "p2"),
    ("plan", "origin/e2"),
    ("blame", "p1", "--at", "origin/e1"),
    ("diff", "origin/e1", "origin/e2"),
    ("show", "origin/e1"),
    ("merge", "origin/e1"),
    ("bisect", "start", "origin/e1", "C1", "--expect", "p2.pose.yaw < 10", "-y"),
    ("runs", "list", "--all"),
    ("data", "status"),
    ("check", "C1"),
    ("status",),
)


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_a_command_fetches_what_it_lacks_at_once(
    words: tuple[str, ...], clone: Path, pico: Pico, fetches: list[int]
) -> None:
    answer = pico(*words)
    assert answer.code in (0, 2, 6) and "error" not in answer.err, answer.err
    assert len(fetches) <= 2, "folders in one go, manifests in another"


def test_the_answers_are_those_of_a_whole_clone(
    clone: Path, shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = (("diff", "C1", "E2-3", "--json"), ("show", "E1-3:p2", "--json"))
    here = [pico(*words).data for words in asked]
    verified = pico("verify")
    monkeypatch.chdir(shel)
    assert [pico(*words).data["changes"] for words in asked] == [data["changes"] for data in here]
    assert (pico("verify").code, pico("verify").out) == (verified.code, verified.out)


@pytest.mark.parametrize("words", [c for c in COMMANDS if c[0] not in ("status", "check")], ids=" ".join)
def test_without_its_remote_a_partial_clone_is_named(
    words: tuple[str, ...], clone: Path, server: Path, pico: Pico
) -> None:
    server.rename(server.with_name("away.git"))
    answer = pico(*words)
    if answer.code not in (0, 2):
        assert "this clone is partial" in answer.err and "git fetch --refetch --no-filter origin" in answer.err
    for wrong in ("internal", "damaged", "fsck"):
        assert wrong not in answer.err + answer.out


def test_the_named_command_completes_the_clone(clone: Path, server: Path, pico: Pico) -> None:
    git(clone, "fetch", "-q", "--refetch", "--no-filter", "origin")
    server.rename(server.with_name("away.git"))
    assert pico("plan", "origin/e2").code in (0, 2)


def test_a_fetch_runs_no_program_that_the_repository_names(clone: Path, pico: Pico, tmp_path: Path) -> None:
    script = tmp_path / "upload"
    script.write_text(f'#!/bin/sh\ntouch {tmp_path}/ran\nexec git-upload-pack "$@"\n')
    script.chmod(0o755)
    git(clone, "config", "remote.origin.uploadpack", str(script))
    answer = pico("diff", "origin/e1", "origin/e2")
    assert answer.code == 1 and "this clone is partial" in answer.err and "remote.origin.uploadpack" in answer.err
    assert not (tmp_path / "ran").exists()


def test_a_clone_that_says_so_by_an_extension_is_read(clone: Path, pico: Pico) -> None:
    git(clone, "config", "core.repositoryFormatVersion", "1")
    git(clone, "config", "extensions.partialClone", "origin")
    assert pico("show", "origin/e1").code == 0


def test_an_object_that_no_commit_holds_is_not_asked_for(clone: Path, fetches: list[int]) -> None:
    handle = partial.open_handle(clone)
    with pytest.raises(KeyError):
        handle["c" * 40]
    assert "d" * 40 not in handle and len(fetches) <= 1
