"""Temporary repositories, made by plain git with nothing of the user's configuration."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from giving import Git


@pytest.fixture(autouse=True)
def _own_configuration(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "EMAIL"):
        monkeypatch.delenv(name, raising=False)
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
    monkeypatch.setenv("GIT_CONFIG_SYSTEM", "/dev/null")
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))


@pytest.fixture
def git(tmp_path: Path) -> Git:
    """Return a function that runs git in a folder (`repo` below the temporary one) and returns what it says."""
    (tmp_path / "repo").mkdir(exist_ok=True)

    def run(*arguments: str, at: str = "repo", date: str = "") -> str:
        env = {"GIT_AUTHOR_DATE": date, "GIT_COMMITTER_DATE": date} if date else {}
        done = subprocess.run(
            ["git", *arguments],
            cwd=tmp_path / at,
            env=os.environ | env,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    return run


@pytest.fixture
def repo(git: Git, tmp_path: Path) -> Path:
    """Return a repository with a lab at its root: two commits on main (tag `first`), one more on branch `side`."""
    git("init", "-q", "-b", "main")
    root = tmp_path / "repo"
    (root / "state").mkdir()
    (root / "lab.yaml").write_text("kind: Lab\n")
    for number, commands in enumerate(((), ("tag first",), ("checkout -q -b side",))):
        for command in commands:
            git(*command.split())
        (root / "state" / "table.yaml").write_text(f"x: {number}\n")
        git("add", "-A")
        git("commit", "-q", "-m", f"commit {number}", date=f"2026-01-0{number + 1}T12:00:00+01:00")
    git("checkout", "-q", "main")
    return root


@pytest.fixture
def lab(case_study: Path, tmp_path: Path) -> Path:
    """Return a copy of the case study, where `git` runs."""
    shutil.copytree(case_study, tmp_path / "repo")
    return tmp_path / "repo"
