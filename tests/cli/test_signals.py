"""Terminals that close, links that go, pipes that nobody reads: a run ends in order, and everything else at once."""

from __future__ import annotations

import errno
import os
import pty
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from commanding import Pico
from forking import become
from killed_commands import git
from test_stopping_commands import PROGRAM, moving, started

from pico.bench.bench import Bench
from pico.bench.plans import Plans
from pico.bench.running.attending import attend
from pico.model.trace.event import Event
from pico.runs.journal import Journal

PARTS = ("lx_125", "p2")
APPLY = ("apply", "e1", "--auto-approve", "--", *PARTS)
PLAN = ("plan", "e1", "--detailed-exitcode", "--", *PARTS)
SCRIPT = PROGRAM.replace("from pico_cli.main import main\nsys.exit(main(sys.argv[1:]))", "import pico\n") + (
    f"bench = pico.open('.')\nbench.apply(bench.plan('e1', targets={PARTS}))\nprint('not to be reached')"
)


def on_a_terminal(folder: Path, program: str, *words: str) -> tuple[int, int]:
    """Start `pico` as the leader of a terminal's session; return its process id and the terminal's other end."""
    process, terminal = pty.fork()
    if not process:
        os.chdir(folder)
        become(program, *words)
    return process, terminal


def ended(process: int) -> int:
    """Return the exit code of a process, negative for a signal."""
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


def said(terminal: int, word: str) -> str:
    """Return what a terminal shows until `word` is there."""
    text = ""
    while word not in text:
        text += os.read(terminal, 4096).decode()
    return text


def outcomes(folder: Path) -> list[str | None]:
    journal = Journal(folder / ".pico/benches/sim" / "journal.sqlite")
    try:
        return [run.outcome for run in journal.runs()]
    finally:
        journal.close()


def require_set_down(folder: Path, pico: Pico) -> None:
    """Assert that a run ended safely, and that the next commands go on from there."""
    assert outcomes(folder) == ["interrupted"]
    with Bench.open(folder) as bench:
        assert bench.observe().robots["arm1"].holding is None
    assert pico("status").code == 0
    assert pico(*PLAN).code in (0, 2), "0 if all had been moved when it was ended, on a busy machine"
    assert pico(*APPLY).code == 0
    assert pico(*PLAN).code == 0


TERM, HUP = signal.SIGTERM, signal.SIGHUP


@pytest.mark.parametrize(
    "numbers", [*(pytest.param((n,), marks=pytest.mark.slow) for n in (TERM, HUP)), (HUP, TERM, HUP)]
)
def test_term_and_hup_end_a_run_as_ctrl_c_does_however_often_they_come(
    shel: Path, pico: Pico, numbers: Sequence[int]
) -> None:
    process = started(shel, *APPLY)
    for number in numbers:
        process.send_signal(number)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 130
    assert err.count("Stopping") == 1 and "at once:" not in err and "Interrupted" in out
    require_set_down(shel, pico)


@pytest.mark.parametrize("fidelity", ["kinematic", pytest.param("physics", marks=pytest.mark.slow)])
def test_a_terminal_that_closes_ends_a_run_in_order(shel: Path, pico: Pico, fidelity: str) -> None:
    process, terminal = on_a_terminal(shel, PROGRAM, "apply", "--fidelity", fidelity, *APPLY[1:])
    moving(shel, lambda: True)
    os.close(terminal)
    assert ended(process) == 130
    require_set_down(shel, pico)


def test_a_terminal_that_closes_on_a_suspended_run_ends_it_in_order(shel: Path, pico: Pico) -> None:
    process = started(shel, *APPLY)
    process.send_signal(signal.SIGSTOP)
    os.waitpid(process.pid, os.WUNTRACED)
    process.send_signal(signal.SIGHUP)
    process.send_signal(signal.SIGCONT)
    process.communicate(timeout=120)
    assert process.returncode == 130
    require_set_down(shel, pico)


def test_a_terminal_that_closes_ends_a_script_once_its_run_is_safe(shel: Path, pico: Pico) -> None:
    process, terminal = on_a_terminal(shel, SCRIPT)
    moving(shel, lambda: True)
    os.close(terminal)
    assert ended(process) == -signal.SIGHUP
    require_set_down(shel, pico)


def test_under_nohup_a_run_goes_on(shel: Path, pico: Pico) -> None:
    def deaf() -> None:
        signal.signal(signal.SIGHUP, signal.SIG_IGN)

    process = started(shel, *APPLY, preexec_fn=deaf)
    process.send_signal(signal.SIGHUP)
    (shel / ".pico" / "goes_on").write_text("")
    _, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert outcomes(shel) == ["done"]


def test_ctrl_backslash_stops_at_once_and_leaves_no_core(shel: Path, pico: Pico) -> None:
    process = started(shel, *APPLY)
    process.send_signal(signal.SIGQUIT)
    (shel / ".pico/benches/sim" / "stop.json").write_text(
        '{"token": 0, "how": "now"}'
    )  # what waits goes on; it is for nobody
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130 and "Stopping at once" in err
    with Bench.open(shel) as bench:
        assert bench.observe().robots["arm1"].holding is not None
    assert pico("recover", "--auto-approve").code == 0
    assert pico(*APPLY).code == 0


def test_a_terminal_that_closes_while_it_asks_moves_nothing(shel: Path) -> None:
    process, terminal = on_a_terminal(shel, PROGRAM, "apply", "e1")
    said(terminal, "[y/N]")
    os.close(terminal)
    assert ended(process) == 130
    assert not (shel / ".pico" / "waits").exists()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_plan_is_not_waited_for(
    shel: Path, pico: Pico, monkeypatch: pytest.MonkeyPatch, number: signal.Signals
) -> None:
    import threading

    enough, planned = threading.Event(), threading.Event()

    def endless(self: Plans, *_: object, **__: object) -> None:
        os.kill(os.getpid(), number)
        enough.wait(60)
        planned.set()

    before = signal.signal(number, signal.SIG_DFL)
    monkeypatch.setattr(Plans, "plan", endless)
    answer = pico("plan", "e1")
    enough.set()
    assert (answer.code, planned.is_set()) == (130, False)
    assert "interrupted; nothing has moved" in answer.err
    assert signal.signal(number, before) == signal.SIG_DFL


def test_watching_ends_with_its_terminal(shel: Path) -> None:
    process, terminal = on_a_terminal(shel, PROGRAM, "drift", "--watch", "--interval", "60")
    said(terminal, "cam.exposure")
    os.close(terminal)
    assert ended(process) == 0


def test_a_check_ends_with_its_terminal_and_leaves_nothing(
    shel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / "own"
    own.mkdir()
    monkeypatch.setenv("TMPDIR", str(own))
    (shel / ".pico").mkdir(exist_ok=True)
    git(shel, "checkout", "-q", "e1")
    process, terminal = on_a_terminal(shel, PROGRAM, "check", "main")
    moving(shel, lambda: True)
    os.close(terminal)
    (shel / ".pico" / "goes_on").write_text("")
    assert ended(process) == 130
    assert list(own.iterdir()) == []


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_pipe_that_nobody_reads_does_not_end_a_run(shel: Path, stream: str) -> None:
    process = started(shel, *APPLY)
    getattr(process, stream).close()
    (shel / ".pico" / "goes_on").write_text("")
    assert process.wait(120) == 0
    assert outcomes(shel) == ["done"]


def test_a_run_whose_events_cannot_be_shown_is_ended_in_order(shel: Path, pico: Pico) -> None:
    def full(event: Event) -> None:
        if event.kind == "operation_progress":
            raise OSError(errno.ENOSPC, "no space left on device")

    with Bench.open(shel) as bench, pytest.raises(OSError, match="no space"):
        attend(bench.run(bench.plan("e1", targets=PARTS)), full)
    require_set_down(shel, pico)


def test_streams_that_were_closed_at_the_start_are_no_mistake(shel: Path) -> None:
    command = 'exec "$0" -c "$1" apply e1 --auto-approve >&- 2>&-'
    (shel / ".pico").mkdir(exist_ok=True)
    (shel / ".pico" / "waits").write_text("")
    done = subprocess.run(["sh", "-c", command, sys.executable, PROGRAM], cwd=shel, check=False, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert outcomes(shel) == ["done"]
