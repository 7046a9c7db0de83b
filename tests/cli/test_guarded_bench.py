"""A bench that PICO takes for a real one, with lasers at the wire: light is guarded while no command runs, and a stop
ends it. Its emulators are a process of their own, see `benchmarks/safety_world.py`."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
from commanding import Pico

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
sys.path.append(str(BENCHMARKS))

from safety_chain import Chain  # noqa: E402

pytestmark = [pytest.mark.slow, pytest.mark.skipif(not find_spec("xarm"), reason="the extra xarm")]
REAL = ("--backend", "hardware")


@pytest.fixture
def chain(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Chain]:
    monkeypatch.setenv("PICO_EMULATED_PACE", "10")
    found = Chain(tmp_path / "lab", dead_man=False)
    monkeypatch.chdir(found.lab)
    try:
        found.light()
        yield found
    finally:
        found.close()


def dark(chain: Chain, within: float) -> bool:
    until = time.monotonic() + within
    while any(chain.ask("lit").values()) and time.monotonic() < until:
        time.sleep(0.01)
    return not any(chain.ask("lit").values())


def until(true: Callable[[], bool]) -> None:
    began = time.monotonic()
    while not true():
        assert time.monotonic() - began < 10
        time.sleep(0.02)


def test_light_ends_though_no_command_runs_and_every_command_says_why(chain: Chain, pico: Pico) -> None:
    guard = chain.guard()
    assert guard and guard != os.getpid(), "a process of its own guards light that a command let out"
    chain.ask("pull", "door_box", True)
    assert dark(chain, 0.7)
    for words in (("status",), ("laser",)):
        said = pico(*REAL, *words)
        assert "light of bare, laser was ended at" in said.err and "door_box (door) is not safe" in said.err, words
    runs = pico(*REAL, "--json", "runs").data["runs"]
    assert any("ended light: door_box (door) is not safe" in str(run) for run in runs), runs


def test_a_stop_ends_light_whether_or_not_anything_moves_and_names_each_laser(chain: Chain, pico: Pico) -> None:
    stopped = pico(*REAL, "stop", "--now")
    assert stopped.code == 0 and not any(chain.ask("lit").values())
    assert "Nothing moves" in stopped.out
    assert "bare is dark: bare.emission read back." in stopped.out
    assert "laser is dark: laser.shutter, laser.emission read back." in stopped.out
    chain.light()
    chain.ask("freeze", "light", True)
    failed = pico(*REAL, "--json", "stop", "--now")
    assert failed.code == 1 and {one["laser"]: one["dark"] for one in failed.data["light"]["lasers"]} == {
        "bare": False, "laser": False
    }  # fmt: skip
    chain.ask("freeze", "light", False)


def test_a_guard_that_was_killed_is_told_by_the_next_command_and_followed_by_another(chain: Chain, pico: Pico) -> None:
    guard = chain.guard()
    os.kill(guard, signal.SIGKILL)
    until(lambda: chain.guard() == 0)
    said = pico(*REAL, "laser")
    assert f"(pid {guard}) has ended; bare, laser may have emitted unwatched since" in said.err
    assert all(chain.ask("lit").values()), "without a dead-man nothing ends it"
    assert chain.guard() not in (0, guard), "a command that leaves light on starts a guard"
    chain.ask("pull", "lock", True)
    assert dark(chain, 0.7)


def test_a_guard_that_is_ended_ends_light(chain: Chain) -> None:
    os.kill(chain.guard(), signal.SIGTERM)
    assert dark(chain, 5.0)
    until(lambda: chain.guard() == 0)
