"""What goes by the real coordinator and edge: a goal that is sought, and keys in a terminal whose client freezes."""

from __future__ import annotations

import json
import os
import pty
import re
import select
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from commanding import Pico, edit
from relaying import TOKEN, point, relayed


@pytest.fixture
def lab(shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A checkout whose bench is one at a coordinator, in a world that stands still, with its light on the camera."""
    edit(shel / "lab.yaml", "  seed: 1\n", "  seed: 1\n  environment: none\n")
    assert pico("apply", "e1", "--yes").code == 0
    monkeypatch.setenv("PICO_TOKEN", TOKEN)
    with relayed(shel) as url:
        point(shel, url)
        yield shel


@pytest.mark.slow
def test_a_goal_is_sought_at_the_edge_of_a_coordinator(lab: Path, pico: Pico) -> None:
    lines = pico("optimize", "center", "ly_150", "cam", "--yes", "--json").out.splitlines()
    found = json.loads(lines[-1])
    assert found["schema"] == "pico.optimization/v1" and found["met"]
    assert any(json.loads(line)["kind"] == "operation_progress" for line in lines[:-1])
    seen = pico("measure", "cam.centroid", "--json").data["value"]
    assert abs(seen["x"]) < 5 and abs(seen["y"]) < 5


class Terminal:
    """A command in a terminal that reports releases, and answers what it is asked in a thread of its own."""

    def __init__(self, *words: str) -> None:
        self.process, self.link = pty.fork()
        if self.process == 0:
            code = 1
            try:
                from pico_cli.main import main

                sys.stdin, sys.stdout, sys.stderr = os.fdopen(0, "r"), os.fdopen(1, "w"), os.fdopen(2, "w")
                code = main([*words])
            finally:
                os._exit(code)
        self.shown = b""
        threading.Thread(target=self._read, daemon=True).start()

    def type(self, data: bytes) -> None:
        """Press keys."""
        os.write(self.link, data)

    def hold(self, right: bytes, until: Callable[[], bool]) -> None:
        """Hold a key down; where what it moves stands still (the edge missed it for once), it is pressed anew."""
        end, seen, since = time.monotonic() + 60, 0.0, 0.0
        while not until():
            now = time.monotonic()
            assert now < end, self.shown
            if (at := self.last()) != seen:
                seen, since = at, now
            if now - since > 1:
                since = now
                self.type(right + b"3C" + right + b"1C")
            self.type(right + b"2C")
            time.sleep(0.03)

    def last(self) -> float:
        """Return the angle that was shown last [deg]; less than any before the first."""
        shown = re.findall(rb"angle (-?[0-9.]+) deg", self.shown)
        return float(shown[-1]) if shown else float("-inf")

    def wait_for(self, text: bytes) -> None:
        """Wait until something is shown."""
        until = time.monotonic() + 60
        while text not in self.shown:
            assert time.monotonic() < until, self.shown
            time.sleep(0.01)

    def _read(self) -> None:
        with suppress(OSError):
            while select.select([self.link], [], []) and (data := os.read(self.link, 65536)):
                self.shown += data
                os.write(self.link, b"\x1b[?1u" * data.count(b"\x1b[?u") + b"\x1b[?6c" * data.count(b"\x1b[c"))
                os.write(self.link, b"\x1b[0n" * data.count(b"\x1b[5n"))


@pytest.mark.slow
def test_who_is_frozen_with_a_key_held_moves_nothing_more(lab: Path, pico: Pico) -> None:
    def angle() -> float:
        return float(pico("get", "p2.angle", "--json").data["values"]["angle"]["value"])

    before, terminal = angle(), Terminal("teleop", "p2.angle", "--step", "1 deg", "--yes")
    try:
        terminal.wait_for(b"step 1 deg")
        terminal.hold(b"\x1b[1;1:", lambda: terminal.last() >= before + 3)
        os.kill(terminal.process, signal.SIGSTOP)
        time.sleep(0.3)
        still = angle()
        for _ in range(20):
            terminal.type(b"\x1b[1;1:2C")
            time.sleep(0.03)
        assert still == angle() and still >= before + 3
        until = time.monotonic() + 60
        while pico("lease", "show", "--json").data["holder"] is not None:
            assert time.monotonic() < until
            time.sleep(0.1)
        assert still == angle()
        run = pico("runs", "show", "--json").data
        assert run["operations"][-1]["primitive"] == "teleoperate", run
    finally:
        os.kill(terminal.process, signal.SIGKILL)
        os.waitpid(terminal.process, 0)
        os.close(terminal.link)
