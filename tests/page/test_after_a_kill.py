"""A folder whose `pico gui` was killed: commands work in it, what was before is put back, and the next one opens."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from pico.edge.link import place
from pico.edge.network.remotes import Remote, Remotes, keep, known

PICO = [sys.executable, "-m", "pico_cli"]


@contextmanager
def opened(lab: Path, environment: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    """Run `pico gui` until it has told its address; ended where nobody else does."""
    going = subprocess.Popen(
        [*PICO, "-C", lab, "--json", "gui", "--no-open"], env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
    )  # fmt: skip
    try:
        assert going.stdout is not None and going.stderr is not None
        line = going.stdout.readline()
        assert line, going.stderr.read()
        assert json.loads(line)["address"].startswith("http://127.0.0.1:")
        yield going
    finally:
        going.terminate()
        going.communicate(timeout=60)


@pytest.mark.slow
def test_a_killed_page_leaves_the_folder_in_order(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CONFIG_HOME": str(tmp_path / "config"), "XDG_STATE_HOME": str(tmp_path / "state")}
    lab = tmp_path / "lab"

    def said(*words: str) -> str:
        done = subprocess.run([*PICO, "-C", lab, *words], env=environment, text=True, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    subprocess.run([*PICO, "init", "--example", "shel", lab], env=environment, check=True, capture_output=True)
    keep(lab, before := Remotes({"lab": Remote("https://lab.example")}))
    with opened(lab, environment) as page:
        assert known(lab).default == "gui/shel/bench1"
        page.send_signal(signal.SIGKILL)
        page.wait()
        assert "live (sim)" in said("status")
    assert known(lab) == before
    until = time.monotonic() + 60
    while place.find(lab) is not None:
        assert time.monotonic() < until, "the edge goes on without its coordinator"
        time.sleep(0.1)
    said("sim", "nudge", "hwp", "--dx", "1")  # the bench is its folder's own
    with opened(lab, environment):
        assert "live (sim)" in said("status")
    assert known(lab) == before and not (lab / ".pico/enrolment.json").exists()
