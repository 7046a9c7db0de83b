"""The README's tour in a real browser, by mouse and keyboard, against `pico gui` and its bench in the twin."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

UI = Path(__file__).resolve().parent.parent.parent / "ui"
CHROMIUM = shutil.which("chromium")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not here: `make test-gui` installs it where it can"),
    pytest.mark.skipif(shutil.which("node") is None, reason="Node is not here"),
    pytest.mark.skipif(
        not (UI / "node_modules/playwright-core").is_dir(), reason="`make test-gui` installs what drives the browser"
    ),
]


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    """Yield where the page of an example lab is, with the code that lets in."""
    environment = os.environ | {"XDG_CONFIG_HOME": str(tmp_path / "config"), "XDG_STATE_HOME": str(tmp_path / "state")}
    pico = [sys.executable, "-m", "pico_cli"]
    lab = tmp_path / "lab"
    subprocess.run([*pico, "init", "--example", "shel", lab], env=environment, check=True, capture_output=True)
    serving = subprocess.Popen(
        [*pico, "-C", lab, "--json", "gui", "--no-open"], env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    try:
        assert serving.stdout is not None
        yield json.loads(serving.stdout.readline())["address"]
    finally:
        serving.send_signal(signal.SIGTERM)
        serving.wait(60)
    assert not (lab / ".pico/enrolment.json").exists(), "the bench is its folder's own again"


def test_the_tour(address: str) -> None:
    environment = os.environ | {"CHROMIUM": str(CHROMIUM)}
    done = subprocess.run(
        ["node", UI / "test/browser/tour.mjs", address], env=environment, text=True, capture_output=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "The tour is over." in done.stdout
