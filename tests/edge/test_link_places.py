"""Which bench a command reaches where one is served, and what it makes of one that answers something else."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
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
        assert place.find(example) is not None
        assert place.find(copy) is None


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
