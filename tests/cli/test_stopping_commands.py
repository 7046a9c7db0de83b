"""Stopped, killed, resumed, undone: what a person types after a run that did not reach its end."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from commanding import Pico

from pico.bench import Bench
from pico.journal import Journal


def started(folder: Path, *words: str) -> subprocess.Popen[str]:
    """Start `pico` as a process of its own, with an arm so slow in wall time that it can be caught."""
    program = """
import sys, time
from pico.backends.sim import session
tell = session.Session._tell
def slowly(self, kind, *rest):
    time.sleep(0.02)
    tell(self, kind, *rest)
session.Session._tell = slowly
from pico_cli.main import main
sys.exit(main(sys.argv[1:]))
"""
    return subprocess.Popen(
        [sys.executable, "-c", program, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def until_something_moves(folder: Path) -> None:
    path = folder / ".pico" / "journal.sqlite"
    for _ in range(1000):
        if path.exists():
            journal = Journal(path)
            moving = any(r.kind == "started" and r.data for r in journal.records() if "laser" not in r.component)
            journal.close()
            if moving:
                return
        time.sleep(0.02)
    raise AssertionError("nothing moves")


@pytest.mark.parametrize("how", [(), ("--now",)])
def test_stop_needs_no_lock_and_the_run_can_be_resumed_and_undone(shel: Path, pico: Pico, how: tuple[str, ...]) -> None:
    process = started(shel, "apply", "e1", "--auto-approve")
    until_something_moves(shel)
    locked = pico("apply", "e1", "--auto-approve")
    assert locked.code == 5 and f"process {process.pid}" in locked.err
    stopped = pico("stop", *how)
    assert stopped.code == 0 and f"process {process.pid}" in stopped.out and "pico resume" in stopped.out
    out, _ = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "Interrupted" in out and "pico resume" in out
    assert pico("resume", "--auto-approve").code == 0
    assert pico("plan", "e1", "--detailed-exitcode").code == 0
    assert pico("resume").code == 1
    assert pico("undo", "--auto-approve").code == 0
    before = {n: p.pose for n, p in Bench.open(shel).observe().components.items()}
    assert before["lx_125"] is not None and before["lx_125"].x == 290  # at home again


def test_sigterm_ends_a_run_as_ctrl_c_does(shel: Path, pico: Pico) -> None:
    process = started(shel, "apply", "e1", "--auto-approve")
    until_something_moves(shel)
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "Stopping" in err and "Interrupted" in out
    seen = Bench.open(shel).observe()
    assert seen.robots["arm1"].holding is None


def test_after_a_kill_what_began_is_settled_and_what_is_held_set_down(shel: Path, pico: Pico) -> None:
    process = started(shel, "apply", "e1", "--auto-approve")
    until_something_moves(shel)
    for _ in range(500):
        if Bench.open(shel).observe().robots["arm1"].holding:
            break
        time.sleep(0.01)
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=30)
    held = Bench.open(shel).observe().robots["arm1"].holding
    assert held is not None
    assert pico("recover", "--auto-approve").code == 0
    assert Bench.open(shel).observe().robots["arm1"].holding is None
    journal = Journal(shel / ".pico" / "journal.sqlite")
    assert journal.unsettled() == ()
    assert any(r.kind == "resolved" and r.component == held for r in journal.records())
    journal.close()
    assert pico("apply", "e1", "--auto-approve").code == 0


def test_nothing_to_stop_or_to_undo_is_said(shel: Path, pico: Pico) -> None:
    assert "Nothing moves" in pico("stop").out
    assert pico("undo").code == pico("resume").code == 1
    assert "nobody asks about x" in pico("recover", "--done", "x").err
