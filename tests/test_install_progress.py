"""`make` says what pip does while it installs, and shows what pip printed if it fails."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

FILE = Path(__file__).resolve().parent.parent / ".ci" / "install.py"
spec = importlib.util.spec_from_file_location("install_progress", FILE)
assert spec and spec.loader
install = importlib.util.module_from_spec(spec)
spec.loader.exec_module(install)


def test_each_step_of_pip_is_said_in_a_few_words() -> None:
    progress = install.Progress()
    lines = {
        "Looking in links: wheels": "starting",
        "Collecting numpy==2.1.0 (from -c constraints.txt (line 4))": "package 1: numpy",
        "  Downloading numpy-2.1.0-cp311-manylinux_x86_64.whl (16.3 MB)": "package 1: downloading numpy",
        "Collecting mujoco>=3": "package 2: mujoco",
        "Installing collected packages: mujoco, numpy": "unpacking 2 packages",
    }
    for line, doing in lines.items():
        progress.read(line)
        assert progress.doing == doing and str(progress).endswith(doing)


def test_what_pip_printed_is_shown_if_it_fails(capfd: pytest.CaptureFixture[str]) -> None:
    assert install.install(["--no-index", "there-is-no-such-package"]) != 0
    assert "there-is-no-such-package" in capfd.readouterr().err
