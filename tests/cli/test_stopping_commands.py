"""Stopped, killed, resumed, undone: what a person types after a run that did not reach its end."""

from __future__ import annotations

import signal
import subprocess
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import forking
import pytest
from commanding import Pico

from pico.bench.bench import Bench
from pico.edge.lease import BenchLock
from pico.runs.journal import Journal

PROGRAM = """
import sys, time
from contextlib import closing
from pathlib import Path
from pico.backends.sim import session
from pico.bench.running import execution

halt, tell, notes = execution.Execution.halt, session.WorldSession._tell, Path(".pico")

def waits(self, kind, operation, key, data):
    tell(self, kind, operation, key, data)
    if data.get("phase") == "transit" and not (notes / "waits").exists():
        (notes / "waits").write_text("")
        until, ends = time.monotonic() + 60, (notes / "benches/sim/stop.json", notes / "goes_on")
        while time.monotonic() < until and not any(path.exists() for path in ends):
            time.sleep(0.01)

def halts(self):
    halt(self)
    (notes / "goes_on").write_text("")

execution.Execution.halt, session.WorldSession._tell = halts, waits
from pico_cli.main import main
sys.exit(main(sys.argv[1:]))
"""


def started(folder: Path, *words: str, **options: Any) -> subprocess.Popen[str]:
    """Start `pico` as a process of its own, which waits with the first part in the hand until it is stopped."""
    process = forking.started(PROGRAM, *words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
    moving(folder, lambda: process.poll() is None)
    return process


def moving(folder: Path, alive: Callable[[], bool]) -> None:
    """Wait until the first part is in the hand."""
    for _ in range(6000):
        if (folder / ".pico" / "waits").exists():
            return
        assert alive()
        time.sleep(0.01)
    raise AssertionError("nothing moves")


@pytest.mark.parametrize("how", [pytest.param((), marks=pytest.mark.slow), ("--now",)])
def test_stop_needs_no_lock_and_the_run_can_be_resumed_and_undone(shel: Path, pico: Pico, how: tuple[str, ...]) -> None:
    process = started(shel, "apply", "e1", "--auto-approve")
    locked = pico("apply", "e1", "--auto-approve")
    assert locked.code == 5 and f"process {process.pid}" in locked.err
    stopped = pico("stop", *how)
    assert stopped.code == 0 and f"process {process.pid}" in stopped.out and "pico resume" in stopped.out
    out, _ = process.communicate(timeout=120)
    assert process.returncode == 130
    assert "Interrupted" in out and "pico resume" in out
    told = " ".join(pico("status").err.split())
    assert told.count("warning[cut-short]: run ") == 1 and "was interrupted" in told and "`pico resume`" in told
    assert pico("resume", "--auto-approve").code == 0
    assert pico("plan", "e1", "--detailed-exitcode").code == 0
    assert "cut-short" not in pico("status").err
    assert pico("resume").code == 1
    assert pico("undo", "--auto-approve").code == 0
    before = {n: p.pose for n, p in Bench.open(shel).observe().components.items()}
    assert before["lx_125"] is not None and before["lx_125"].x == 290  # at home again


def test_after_a_kill_what_began_is_settled_and_what_is_held_set_down(shel: Path, pico: Pico) -> None:
    apply = ("apply", "e1", "--auto-approve", "--", "lx_125", "p2")
    process = started(shel, *apply)
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=120)
    held = Bench.open(shel).observe().robots["arm1"].holding
    assert held is not None
    for words in (["status"], ["plan"], ["drift"]):
        told = pico(*words)
        said = " ".join(told.err.split())
        assert said.count("warning[cut-short]: run ") == 1 and f"was killed, and arm1 holds {held}" in said
        assert "`pico resume` takes the run up again" in said and "`pico recover` only sets down" in said
        assert "cut-short" in pico(*words, "--json").out
    refused = pico("commit", "-m", "nothing")
    assert refused.code == 1 and f"arm1 holds {held}" in " ".join(refused.err.split())
    operations = pico("plan", "--json").data["operations"]
    moved = {op["component"] for op in operations if op["reason"]["kind"] != "interlock"} - {"arm1"}
    assert held in moved and f"  {9 - len(moved)} components of 9 stay as is\n" in pico("plan").out
    drifted = pico("drift").out
    assert f"`pico recover` sets down what a gripper holds: {held}." in drifted and "only you" not in drifted
    full = pico("calibrate")
    assert full.code == 1 and f"arm1 holds {held}: a calibration needs its hand" in full.err
    with Bench.open(shel) as bench:
        at_home = bench.plans.single("ly_200", "move", {"slot": "storage/a4"})
    assert at_home.operations and at_home.asked, "what sets the held part down does not lead to the manifest"
    one = pico("set", "cam", "exposure=5")
    assert one.code == 0 and "cut-short" in one.err and f"arm1 still holds {held}" in one.out
    assert "pico resume" not in pico("verify").err  # the last run is that one
    assert "which picked it" in drifted and "by hand" not in drifted
    whole = pico("commit", "--capture", "-m", "in between")
    assert whole.code == 1 and f"error[in-hand]: arm1 holds {held}" in whole.err
    assert pico("capture").code == 1 and pico("capture", "cam").code == 0
    assert "cut-short" in pico("commit", "cam", "--capture", "-m", "in between").err
    assert any(line.split()[0] == held and "held" in line for line in pico("catalog", "parts").out.splitlines()[1:-2])
    assert pico("recover", "--auto-approve").code == 0
    assert "cut-short" not in pico("status").err
    assert "Nothing to do: no gripper holds anything" in pico("recover").out
    assert Bench.open(shel).observe().robots["arm1"].holding is None
    journal = Journal(shel / ".pico/benches/sim" / "journal.sqlite")
    assert journal.unsettled() == ()
    assert any(r.kind == "resolved" and r.component == held for r in journal.records())
    journal.close()
    assert pico(*apply).code == 0


@pytest.mark.parametrize("hand", [("nudge", "--dy", "8"), ("remove",)])
def test_who_takes_a_part_out_of_a_gripper_is_told_so_and_nobody_says_it_is_held(
    shel: Path, pico: Pico, hand: tuple[str, ...]
) -> None:
    process = started(shel, "apply", "e1", "--auto-approve", "--", "lx_125")
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=120)
    done = pico("sim", hand[0], "lx_125", *hand[1:])
    assert done.code == 0 and "taken out of the gripper of arm1, which is open now" in done.out
    said = pico("status")
    assert "cut-short" in said.err and "holds" not in said.err + said.out
    assert "holds" not in pico("plan", "e1").out
    assert "gripper of" not in pico("sim", "nudge", "lx_125", "--dy", "1").out


def test_what_was_set_down_after_a_kill_is_undone_to_where_it_was_before_the_run(shel: Path, pico: Pico) -> None:
    pico("sim", "nudge", "lx_125", "--dx", "5", "--dy", "-6", "--dyaw", "45")
    before = {n: p.pose for n, p in Bench.open(shel).observe().components.items()}
    process = started(shel, "apply", "e1", "--auto-approve", "--", "lx_125")
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=120)
    assert Bench.open(shel).observe().robots["arm1"].holding == "lx_125"
    assert pico("recover", "--auto-approve").code == 0
    assert pico("sim", "nudge", "lx_125", "--dx", "-4", "--dyaw", "-45").code == 0  # as if it had been set down so
    answer = pico("undo", "--auto-approve")
    assert answer.code == 0 and "The bench equals the state before run" in answer.out
    assert {n: p.pose for n, p in Bench.open(shel).observe().components.items()} == before


def test_of_a_run_that_was_killed_before_it_moved_anything_that_is_told(shel: Path, pico: Pico) -> None:
    """`pico runs list` has no such run."""
    with Bench.open(shel) as bench:
        plan = bench.plan("e1")
    with closing(Journal(shel / ".pico/benches/sim" / "journal.sqlite")) as journal:
        journal.begin_run("r1", plan.digest, "test", document=plan.to_json())
    (shel / ".pico/benches/sim" / "run").write_text("r1")
    assert "run r1 was killed before it moved anything" in " ".join(pico("status").err.split())


def test_nothing_to_stop_or_to_undo_is_said(shel: Path, pico: Pico) -> None:
    assert "Nothing moves" in pico("stop").out
    assert pico("undo").code == pico("resume").code == 1
    assert "nobody asks about x" in pico("recover", "--done", "x").err


def test_resume_of_another_run_hints_at_what_works(shel: Path, pico: Pico) -> None:
    assert pico("set", "cam", "exposure=3", "-y").code == 0
    assert pico("set", "cam", "exposure=4", "-y").code == 0
    first = pico("runs", "list", "--json").data["runs"][-1]["document"]["id"]
    unknown = pico("resume", "nope", "-y")
    assert unknown.code == 1 and "no run `nope`" in unknown.err and "`pico undo nope`" not in unknown.err
    older = " ".join(pico("resume", first, "-y").err.split())
    assert f"`pico runs show {first}`" in older and "`pico resume " not in older
    assert pico("runs", "show", first).code == 0


def test_a_run_has_the_name_of_the_command_that_began_it(shel: Path, pico: Pico, monkeypatch: Any) -> None:
    heard = list[str]()
    acquire = BenchLock.acquire

    def hears(self: BenchLock, holder: str) -> Any:
        heard.append(holder)
        return acquire(self, holder)

    monkeypatch.setattr(BenchLock, "acquire", hears)
    for words in (("set", "cam", "exposure=3"), ("do", "cam", "set", "exposure=4"), ("undo",), ("apply", "e1")):
        assert pico(*words, "-y").code == 0
    assert heard == ["pico set", "pico do", "pico undo", "pico apply"]
