"""A repository with the example lab, to branch off and to check."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from changing import Lab


@pytest.fixture
def lab(case_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Lab:
    """The example on a branch `change` of main; no git configuration, no continuous integration."""
    for name in [n for n in os.environ if n.startswith(("CI_", "GITHUB_"))]:
        monkeypatch.delenv(name)
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.setenv("GIT_CONFIG_SYSTEM", os.devnull)
    shutil.copytree(case_study, tmp_path / "shel")
    found = Lab(tmp_path / "shel")
    subprocess.run(["git", "checkout", "-q", "-b", "change"], cwd=found.root, check=True)
    monkeypatch.chdir(found.root)
    return found
