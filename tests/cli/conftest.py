"""The example laboratory, for commands to work in."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable
from contextlib import chdir
from pathlib import Path
from typing import Any

import pytest
from commanding import Brought

from pico.history.git.attributes import install

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "edge"))  # for what serves benches there


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


@pytest.fixture(scope="session")
def _brought() -> dict[object, tuple[Path, Any]]:
    return {}


@pytest.fixture
def brought(
    example: Path, shel: Path, _brought: dict[object, tuple[Path, Any]], tmp_path_factory: pytest.TempPathFactory
) -> Brought:
    """Functions are called once, in a copy of the example as the current directory; `shel` becomes a copy of that."""

    def at(bring: Callable[[Path], Any]) -> Any:
        if bring not in _brought:
            folder = shutil.copytree(example, tmp_path_factory.mktemp("brought") / "shel")
            with chdir(folder):
                _brought[bring] = folder, bring(folder)
        folder, found = _brought[bring]
        for path in shel.iterdir():
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        shutil.copytree(folder, shel, dirs_exist_ok=True)
        return found

    return at
