"""The README's tour in a real browser, by mouse and keyboard, against `pico gui` and its bench in the twin."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from bench_at import bench_at

from pico.edge.link import place

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


class Served:
    """`pico gui` for an example lab in `folder`."""

    def __init__(self, folder: Path) -> None:
        own = {"XDG_CONFIG_HOME": str(folder / "config"), "XDG_STATE_HOME": str(folder / "state")}
        self.lab, self._environment = folder / "lab", os.environ | own
        self.said("init", "--example", "shel", str(self.lab), at=folder)
        self.process, self.address = self.begin()

    def said(self, *words: str, at: Path | None = None) -> str:
        """Return what a command said that did what it should."""
        whole = [sys.executable, "-m", "pico_cli", "-C", at or self.lab, *words]
        return subprocess.run(whole, env=self._environment, text=True, capture_output=True, check=True).stdout

    def begin(self, port: int = 0) -> tuple[subprocess.Popen[str], str]:
        """Serve the page, and return its process and where it is, with the code that lets in."""
        serving = subprocess.Popen(
            [sys.executable, "-m", "pico_cli", "-C", self.lab, "--json", "gui", "--no-open", "--port", str(port)],
            env=self._environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip
        assert serving.stdout is not None
        return serving, json.loads(serving.stdout.readline())["address"]

    def kill(self) -> None:
        """Kill the coordinator, and wait until the edge has ended by itself."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        until = time.monotonic() + 60
        while place.find(bench_at(self.lab)) is not None:
            assert time.monotonic() < until, "the edge goes on without its coordinator"
            time.sleep(0.1)

    def end(self) -> None:
        """Serve no more."""
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(60)


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    found = Served(tmp_path)
    try:
        yield found
    finally:
        found.end()
    assert not (found.lab / ".pico/benches/sim/enrolment.json").exists(), "the bench is its folder's own again"


def begun(script: str, *words: str) -> subprocess.Popen[str]:
    environment = os.environ | {"CHROMIUM": str(CHROMIUM)}
    whole = ["node", UI / "test/browser" / script, *words]
    pipe = subprocess.PIPE
    return subprocess.Popen(whole, env=environment, text=True, stdin=pipe, stdout=pipe, stderr=pipe)


def test_the_tour(served: Served) -> None:
    done = begun("tour.mjs", served.address)
    said, wrong = done.communicate()
    assert done.returncode == 0, said + wrong
    assert "The tour is over." in said


def test_two_people_and_a_coordinator_that_is_killed(served: Served) -> None:
    code = json.loads(served.said("--json", "token", "invite", "ann", "operator@shel"))["made"]["secret"]
    going, said = begun("together.mjs", served.address, code), []
    assert going.stdout is not None
    for line in going.stdout:
        said.append(line.strip())
        if said[-1] == "gone?":
            served.kill()
        elif said[-1] == "back?":
            served.process, _ = served.begin(urlsplit(served.address).port or 0)
    _, wrong = going.communicate()
    assert going.returncode == 0, "\n".join([*said, wrong])
    assert {"One had the bench at a time.", "The line is back."} <= set(said)
