"""Which bench a command reaches where one is served, and what it makes of one that answers something else."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from bench_at import bench_at
from serving import served

import pico
from pico.diagnostics import ExitCode, PicoError
from pico.edge.link import place, wire
from pico.edge.link.client import RemoteEdge
from pico.history.examples.example import make_example


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("shel", tmp_path_factory.mktemp("links") / "shel").root


def test_a_copy_of_a_served_lab_has_a_bench_of_its_own(example: Path, tmp_path: Path) -> None:
    with served(example):
        copy = shutil.copytree(example, tmp_path / "copy")
        assert place.find(bench_at(example)) is not None
        assert place.find(bench_at(copy)) is None


def test_a_socket_that_can_not_be_made_is_told_in_a_line(example: Path, tmp_path: Path) -> None:
    long = tmp_path / ("x" * 100)
    long.mkdir()
    (tmp_path / f"pico-{os.getuid()}").touch()
    for folder, words in ((long, "path too long"), (tmp_path, "file exists")):
        command = [sys.executable, "-m", "pico_cli", "-C", str(example), "edge"]
        told = subprocess.run(
            command, env={**os.environ, "TMPDIR": str(folder)}, capture_output=True, text=True, timeout=60, check=False
        )
        assert told.returncode == ExitCode.ERROR
        assert words in told.stderr and "Traceback" not in told.stderr


def test_a_worktree_that_the_bench_is_not_attached_to_only_looks_at_a_served_one(example: Path, tmp_path: Path) -> None:
    lab = shutil.copytree(example, tmp_path / "shel")
    with pico.open(lab) as bench:
        bench.sim.nudge("p2", dx=5)
    subprocess.run(["git", "worktree", "add", "-q", tmp_path / "other", "e2"], cwd=lab, check=True)
    with served(lab), pico.open(tmp_path / "other") as bench:
        assert isinstance(bench.edge, RemoteEdge)
        plan = bench.plan()
        for act in (lambda: bench.apply(plan), lambda: bench.sim.nudge("p2", dx=5)):
            with pytest.raises(PicoError, match="attached to") as refused:
                act()
            assert refused.value.exit_code == ExitCode.LOCKED


@pytest.mark.parametrize("name", ["describe", "events"])
@pytest.mark.parametrize(
    "data",
    [
        b"garbage\n", b'{"value":', b"\n", b"[]\n", b"5\n", b"{}\n", b'{"error":5,"exit":1}\n',
        b'{"error":[],"exit":99}\n', b"\xff\xfe\n", b"[" * 100_000,
    ],
)  # fmt: skip
def test_an_answer_that_broke_off_or_is_none_is_told_as_such(name: str, data: bytes) -> None:
    with pytest.raises(PicoError, match=f"the edge answered {name} with something else"):
        wire.read_answer(name, data)
