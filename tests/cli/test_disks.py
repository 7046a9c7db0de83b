"""Disks that are full, fail or are read-only: what a command says, and what it leaves."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from bench_at import bench_at
from commanding import Pico
from pico_cli.standing import Standing

from pico.diagnostics import error
from pico.disk import unwritable

BENCHMARK = Path(__file__).resolve().parents[2] / "benchmarks" / "disks.py"
FULL = Path("/dev/full")


@pytest.mark.skipif(not FULL.exists(), reason="there is no /dev/full here")
@pytest.mark.parametrize(
    "words", [("plan", "e1", "--out"), ("calibrate", "markers", "--out"), ("plan", "e1", "--graph", "--out")]
)
def test_a_file_that_a_full_disk_does_not_take_is_named(shel: Path, pico: Pico, words: tuple[str, ...]) -> None:
    answer = pico(*words, str(FULL))
    assert answer.code == 1 and "can't write /dev/full: no space left on the disk mounted at" in answer.err
    assert "mistake in PICO" not in answer.err and not answer.out


@pytest.mark.skipif(not FULL.exists(), reason="there is no /dev/full here")
@pytest.mark.parametrize("words", [("status",), ("--version",), ("catalog", "list", "--json")])
def test_an_answer_that_a_full_disk_does_not_take_is_an_error(shel: Path, words: tuple[str, ...]) -> None:
    program = "import sys; from pico_cli.main import main; sys.exit(main())"
    with FULL.open("w") as full:
        done = subprocess.run(
            [sys.executable, "-c", program, *words],
            cwd=shel,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 1 and "standard output" in done.stderr and "no space left" in done.stderr
    assert "Traceback" not in done.stderr and "Exception" not in done.stderr


def test_where_a_disk_refuses_it_is_told_what_was_not_done_and_nothing_untrue(shel: Path, pico: Pico) -> None:
    full = [unwritable(shel, OSError(errno.ENOSPC, ""))]
    before = Standing(bench_at(shel))
    assert before.told([error("usage", "no disk is wrong")])[1:] == []
    said = before.told(full)[1].summary
    assert said == "nothing moved; the manifests are as they were; no commit was made"
    assert pico("sim", "nudge", "p2", "--dx", "5").code == pico("capture").code == 0
    said = before.told(full)[1].summary
    assert said == "`pico status` shows what moved; manifests changed: `git diff`; no commit was made"
    captured = Standing(bench_at(shel))
    assert pico("commit", "-m", "bumped").code == 0
    said = captured.told(full)[1].summary
    assert said == "nothing moved; the manifests are as they were; HEAD moved: `git log -1`"


def judged(*words: str) -> str:
    if not sys.platform.startswith("linux") or shutil.which("cc") is None:
        pytest.skip("a failing disk is made by a library for Linux, which needs a C compiler")
    done = subprocess.run(
        [sys.executable, str(BENCHMARK), *words], capture_output=True, text=True, check=False, env=dict(os.environ)
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
def test_no_plan_is_left_that_is_empty_or_half() -> None:
    assert " 9  0" in judged("plan --out", "--points", "3")


@pytest.mark.slow
def test_commands_say_truly_what_they_did_not_do() -> None:
    assert judged("capture", "set", "--points", "3").count(" 9  0") == 4
