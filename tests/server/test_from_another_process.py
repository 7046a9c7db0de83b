"""The case study restored through coordinator and edge, each a process of its own, from a third one."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pico.model.plan import plan_from_json

PICO = [sys.executable, "-m", "pico_cli"]


def said(folder: Path, *words: str) -> list[Any]:
    """Return the documents that a command prints as JSON."""
    done = subprocess.run([*PICO, "-C", str(folder), "--json", *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{words}: {done.stdout[-2000:]}{done.stderr[-2000:]}"
    return [json.loads(line) for line in done.stdout.splitlines()]


@contextmanager
def going(folder: Path, *words: str) -> Iterator[Any]:
    """Let a command go on meanwhile that says that it does; yields what it said."""
    with subprocess.Popen([*PICO, "-C", str(folder), "--json", *words], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            yield json.loads(process.stdout.readline())
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait(60)


def digest_apart(plan: dict[str, Any]) -> str:
    """Return the digest of a plan without the bench that it names."""
    return replace(plan_from_json(json.dumps(plan)), bench=None).sealed().digest


def restored(lab: Path) -> tuple[Any, ...]:
    """Return the plan from E3-2 to E1-1, what was done of it in which order, and how the bench then stands."""
    said(lab, "checkout", "E3-2", "-y")
    plan = said(lab, "plan", "E1-1")[0]
    events = said(lab, "checkout", "E1-1", "-y")
    done = [e["operation"] for e in events if e.get("kind") == "operation_done"]
    status = said(lab, "status")[0]
    stands = {f"{row['component']}.{row['tunable']}": row["live"] for row in status["rows"]}
    return digest_apart(plan), [op["id"] for op in plan["operations"]], done, stands


@pytest.mark.slow
def test_a_restoration_through_coordinator_and_edge_is_the_embedded_one(
    case_study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in (("NAME", "A Physicist"), ("EMAIL", "physicist@localhost")):
        monkeypatch.setenv(f"GIT_AUTHOR_{name}", value)
        monkeypatch.setenv(f"GIT_COMMITTER_{name}", value)
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    beside, desk, alone = (Path(shutil.copytree(case_study, tmp_path / n / "shel")) for n in ("table", "desk", "alone"))
    with going(tmp_path, "serve", "--port", "0", "--folder", str(tmp_path / "books")) as serving:
        said(desk, "remote", "add", "lab", serving["url"])
        said(desk, "login", "lab", "--code", serving["code"])
        code = said(desk, "token", "enrol", "shel/bench1")[0]["enrolment"]["code"]
        enrolled = [*PICO, "-C", str(beside), "edge", "enrol", serving["url"], "--code", code]
        subprocess.run(enrolled, check=True, capture_output=True)
        with going(beside, "edge"):
            said(desk, "bench", "use", "shel/bench1")
            assert restored(desk) == restored(alone)
            committed = said(desk, "commit", "-m", "back at E1-1", "--capture")[0]
            assert committed["evidence"] == "kinematic"
    runs = [json.loads(path.read_bytes()) for path in sorted((desk / "runs").rglob("run.json"))]
    assert [run["goal"] for run in runs][-1:] == ["E1-1"] and all(run["outcome"] == "done" for run in runs)
    assert not (beside / "runs").exists()
    assert said(desk, "--bench", "local", "status")[0] != said(alone, "status")[0], "the desk has a bench of its own"
