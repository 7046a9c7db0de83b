"""The example laboratory, for commands to work in."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from pico.history.git.attributes import install


@pytest.fixture(scope="session")
def example(case_study: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("example") / "shel"
    shutil.copytree(case_study, folder)
    install(folder)
    return folder


@pytest.fixture
def shel(example: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example with a new simulated bench, as the current directory; an author, and no git configuration."""
    folder = tmp_path / "shel"
    shutil.copytree(example, folder)
    monkeypatch.chdir(folder)
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.setenv("GIT_CONFIG_SYSTEM", os.devnull)
    return folder
