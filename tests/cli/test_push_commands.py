"""`pico push` and `pico pull`: commits go by git, and never without the data of their runs unless somebody says so."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from commanding import Pico
from data_labs import commit_run, damage, git

from pico.history.data.lab import LabData


@pytest.fixture
def origin(shel: Path, tmp_path: Path) -> Path:
    """Return a bare repository that the lab knows as `origin`; main was pushed."""
    git("init", "-q", "--bare", "-b", "main", str(tmp_path / "origin"))
    git("remote", "add", "origin", str(tmp_path / "origin"))
    git("push", "-q", "-u", "origin", "main")
    return tmp_path / "origin"


@pytest.fixture
def share(shel: Path, tmp_path: Path) -> Path:
    (tmp_path / "share").mkdir()
    git("config", "pico.data.remote", str(tmp_path / "share"))
    return tmp_path / "share"


def tip(origin: Path, branch: str = "main") -> str:
    return git("rev-parse", branch, at=origin).strip()


def held(share: Path) -> set[str]:
    return {p.name for p in share.rglob("*") if p.is_file()}


def test_push_sends_data_and_commits_and_pull_brings_both(
    shel: Path, origin: Path, share: Path, tmp_path: Path, pico: Pico
) -> None:
    git("clone", "-q", str(origin), "clone", at=tmp_path)
    clone = tmp_path / "clone"
    git("config", "pico.data.remote", str(share), at=clone)
    name = commit_run(shel, "run-a", b"frame a")
    answer = pico("push")
    assert answer.code == 0, answer
    assert f"Sent 1 object (7 B) to {share}." in answer.out
    assert "main  →  main" in answer.out
    assert tip(origin) == tip(shel)
    answer = pico("-C", str(clone), "pull")
    assert answer.code == 0, answer
    assert f"nothing moved: `pico -C {clone} plan` shows what would" in answer.out
    assert LabData.discover(clone).store.get(name) == b"frame a"
    assert (clone / "runs" / "2026" / "11" / "run-a" / "run.json").is_file()
    assert pico("-C", str(clone), "pull").out == "Nothing new.\n"


def test_the_data_goes_first(shel: Path, origin: Path, share: Path, pico: Pico) -> None:
    name = commit_run(shel, "run-a", b"frame a")
    (origin / "hooks" / "pre-receive").write_text("#!/bin/sh\necho not today; exit 1\n")
    (origin / "hooks" / "pre-receive").chmod(0o755)
    answer = pico("push")
    assert answer.code == 1
    assert "not today" in answer.err
    assert held(share) == {name}


def test_commits_whose_data_would_stay_behind_are_not_sent(shel: Path, origin: Path, pico: Pico) -> None:
    before = tip(origin)
    commit_run(shel, "run-a", b"frame a")
    answer = pico("push")
    assert answer.code == 1
    assert "1 object (7 B) of runs would stay here" in answer.err
    assert "`git config pico.data.remote FOLDER`" in answer.err
    assert tip(origin) == before
    assert pico("push", "--no-data").code == 0
    assert tip(origin) == tip(shel)


def test_a_lab_without_large_data_needs_no_place_for_it(shel: Path, origin: Path, pico: Pico) -> None:
    git("commit", "-q", "--allow-empty", "-m", "nothing large")
    assert pico("push").code == 0
    assert tip(origin) == tip(shel)


def test_data_that_is_damaged_here_holds_the_commits_back(shel: Path, origin: Path, share: Path, pico: Pico) -> None:
    before = tip(origin)
    damage(LabData.discover(shel).store.path(commit_run(shel, "run-a", b"frame a")))
    answer = pico("push")
    assert answer.code == 1
    assert "is damaged" in answer.err
    assert "the commits were not sent" in answer.err
    assert tip(origin) == before


def test_what_others_failed_to_send_is_told_and_stops_nobody(shel: Path, origin: Path, share: Path, pico: Pico) -> None:
    gone = commit_run(shel, "run-a", b"frame a")
    LabData.discover(shel).store.remove(gone)
    answer = pico("push")
    assert answer.code == 0
    assert "warning[data-missing]: 1 object (7 B) that runs need neither here nor in" in answer.err
    assert tip(origin) == tip(shel)


def test_git_takes_its_own_words_and_options(shel: Path, origin: Path, pico: Pico) -> None:
    git("switch", "-q", "-c", "side")
    answer = pico("push")
    assert answer.code == 1
    assert "has no upstream branch" in answer.err
    assert pico("push", "-u", "origin", "side", "--follow-tags").code == 0
    assert git("rev-parse", "--abbrev-ref", "side@{upstream}").strip() == "origin/side"
    found = pico("push", "origin", "main:elsewhere", "--json").data
    assert [(p["ref"], p["there"]) for p in found["refs"]] == [("refs/heads/main", "refs/heads/elsewhere")]
    assert pico("push", "nowhere").code == 1


def test_a_push_that_comes_second_says_to_pull_and_pull_unites(
    shel: Path, origin: Path, tmp_path: Path, pico: Pico
) -> None:
    git("clone", "-q", str(origin), "clone", at=tmp_path)
    git("commit", "-q", "--allow-empty", "-m", "theirs", at=tmp_path / "clone")
    git("push", "-q", at=tmp_path / "clone")
    git("commit", "-q", "--allow-empty", "-m", "ours")
    answer = pico("push")
    assert answer.code == 1
    assert "error[rejected]: git did not push" in answer.err
    assert "`pico pull`" in answer.err
    assert pico("pull", "--rebase").code == 0
    assert pico("push").code == 0
    assert git("log", "--format=%s", "-2").split() == ["ours", "theirs"]


def test_pull_tells_which_data_it_can_not_bring(
    shel: Path, origin: Path, share: Path, tmp_path: Path, pico: Pico
) -> None:
    git("clone", "-q", str(origin), "clone", at=tmp_path)
    commit_run(shel, "run-a", b"frame a")
    pico("push")
    answer = pico("-C", str(tmp_path / "clone"), "pull")
    assert answer.code == 0
    assert "1 object (7 B) of runs not here and not known" in answer.err
    (tmp_path / "empty").mkdir()
    git("config", "pico.data.remote", "../empty", at=tmp_path / "clone")
    answer = pico("-C", str(tmp_path / "clone"), "pull")
    assert f"not here and not in {tmp_path / 'empty'}" in answer.err


def test_on_a_terminal_git_shows_its_progress_itself(shel: Path, origin: Path) -> None:
    import pty
    import sys

    git("commit", "-q", "--allow-empty", "-m", "more")
    ours, theirs = pty.openpty()
    code = "import sys; from pico_cli.main import main; sys.exit(main(['push', '--progress']))"
    done = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=theirs, text=True, check=False)
    import os

    os.close(theirs)
    seen = os.read(ours, 100_000).decode()
    os.close(ours)
    assert done.returncode == 0, seen
    assert "Writing objects" in seen
    assert "main  →  main" in done.stdout


def test_runs_and_their_data_go_through_a_bare_repository_and_survive_rebase_and_squash(
    shel: Path, origin: Path, share: Path, tmp_path: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pico.runs.files.INLINE", 1000)  # bytes: every trace is large then
    git("switch", "-q", "-c", "work")
    assert pico("apply", "--auto-approve").code == 0
    assert pico("set", "p1", "angle=12", "-y").code == 0
    assert pico("commit", "-m", "p1 a little").code == 0
    assert pico("set", "p1", "angle=13", "-y").code == 0
    assert pico("commit", "-m", "p1 more").code == 0
    needed = {n["sha256"] for n in pico("data", "status", "--json").data["needs"]}
    assert len(needed) >= 2
    git("switch", "-q", "main")
    git("commit", "-q", "--allow-empty", "-m", "meanwhile")
    git("rebase", "-q", "main", "work")
    git("switch", "-q", "-c", "squashed", "main")
    git("merge", "-q", "--squash", "work")
    git("commit", "-q", "-m", "both at once")
    assert pico("push", "-u", "origin", "squashed").code == 0
    git("clone", "-q", "-b", "squashed", str(origin), "clone", at=tmp_path)
    clone = tmp_path / "clone"
    git("config", "pico.data.remote", str(share), at=clone)
    assert pico("-C", str(clone), "runs", "export").code == 1  # its data is not here yet
    assert pico("-C", str(clone), "pull").code == 0
    assert {n["sha256"] for n in pico("-C", str(clone), "data", "status", "--json").data["needs"]} == needed
    assert pico("-C", str(clone), "data", "fsck").code == 0
    made = pico("-C", str(clone), "runs", "export", "--pictures", "none", "--json").data
    assert {f["sha256"] for f in made["files"] if "/artifacts/" in f["path"]} == needed
    assert made["evidence"] == "kinematic"
