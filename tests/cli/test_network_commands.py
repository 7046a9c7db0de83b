"""Commands of a checkout whose bench is at a coordinator: what they say, leave to it, take up again, and stop."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from commanding import Pico
from relaying import TOKEN, point, relayed

from pico.bench.bench import Bench


@pytest.fixture
def far(shel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The bench that is served, of another checkout than the current directory, which means it."""
    monkeypatch.setenv("PICO_TOKEN", TOKEN)
    served = Path(shutil.copytree(shel, tmp_path / "served" / "shel"))
    with relayed(served) as url:
        point(shel, url)
        yield served


@pytest.fixture
def slow(shel: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """As `far`, with an arm that takes its time."""
    monkeypatch.setenv("PICO_TOKEN", TOKEN)
    with relayed(Path(shutil.copytree(shel, tmp_path / "served" / "shel")), pause=0.1) as url:
        point(shel, url)
        yield


@pytest.mark.slow
def test_a_state_is_planned_here_applied_there_and_its_run_comes_into_the_commit(
    far: Path, shel: Path, pico: Pico
) -> None:
    embedded = pico("--json", "--bench", "local", "plan", "e1").data
    planned = pico("--json", "plan", "e1").data
    assert [op["id"] for op in planned["operations"]] == [op["id"] for op in embedded["operations"]]
    assert planned["target"] == embedded["target"] and planned["lab"] == embedded["lab"]
    done = pico("checkout", "e1", "-y")
    assert done.code == 0 and "The bench equals e1" in done.out, done.out + done.err
    committed = pico("commit", "-m", "again", "--capture")
    assert committed.code == 0, committed.err
    runs = list((shel / "runs").rglob("run.json"))
    assert len(runs) == 1 and json.loads(runs[0].read_bytes())["outcome"] == "done"
    assert not (far / "runs").exists() and not (shel / ".pico/benches/sim" / "journal.sqlite").exists()
    assert pico("--bench", "local", "--json", "plan", "e1").data["operations"], "the own bench stands as it stood"


@pytest.mark.slow
def test_a_run_of_somebody_else_is_not_carried_by_this_checkout(
    far: Path, shel: Path, pico: Pico, tmp_path: Path
) -> None:
    other = Path(shutil.copytree(shel, tmp_path / "other" / "shel"))
    with Bench.open(other) as bench:
        bench.apply("e1")
    pico("set", "p1", "angle=3", "-y")
    listed = [line for line in pico("runs").out.splitlines() if "not yet" in line]
    assert len(listed) == 1 and "apply" not in listed[0]


def test_a_run_that_is_left_to_the_bench_is_followed_from_anywhere(far: Path, pico: Pico) -> None:
    assert "no run goes on" in pico("runs", "attach").err
    left = pico("--json", "apply", "e1", "-y", "--detach")
    assert left.code == 0, left.err
    run = json.loads(left.out.splitlines()[-1])["run"]
    followed = pico("--json", "runs", "attach", run[-6:])
    lines = [json.loads(line) for line in followed.out.splitlines()]
    assert followed.code == 0 and lines[0]["kind"] == "run_started" and lines[-1]["outcome"] == "done"
    assert not pico("--json", "plan", "e1").data["operations"]
    assert "1 operation" not in pico("stop").out and "there is no run zzz" in pico("runs", "attach", "zzz").err


def test_without_anybody_who_serves_it_a_run_is_not_left_to_the_bench(shel: Path, pico: Pico) -> None:
    answer = pico("apply", "e1", "-y", "--detach")
    assert answer.code == 1 and "this process is the bench" in answer.err and "`pico edge`" in answer.err


@pytest.mark.slow
@pytest.mark.parametrize("now", [(), ("--now",)])
def test_who_runs_is_stopped_from_another_checkout(slow: None, shel: Path, pico: Pico, now: tuple[str, ...]) -> None:
    words = [sys.executable, "-m", "pico_cli", "apply", "e1", "-y"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=dict(os.environ), cwd=shel) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if "1/" in line:
                break
        stopped = pico("stop", *now)
        assert stopped.code == 0 and "Stopped pico apply" in stopped.out, stopped.err
        process.stdout.read()
        assert process.wait(60) == 130
    assert "interrupted" in pico("runs").out


@pytest.mark.slow
def test_a_client_that_is_killed_ends_no_run(slow: None, shel: Path, pico: Pico) -> None:
    words = [sys.executable, "-m", "pico_cli", "apply", "e1", "-y"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=dict(os.environ), cwd=shel) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if "1/" in line:
                break
        process.kill()
    followed = pico("runs", "attach")
    assert followed.code == 0 or "no run goes on" in followed.err, followed.err
    assert not pico("--json", "plan", "e1").data["operations"]
