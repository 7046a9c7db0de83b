"""Which bench a command reaches where one is served, and what it makes of one that answers something else."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from serving import served

from pico.diagnostics import PicoError
from pico.edge.link import place, wire
from pico.history.examples.example import make_example


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_example("shel", tmp_path_factory.mktemp("links") / "shel").root


def test_a_copy_of_a_served_lab_has_a_bench_of_its_own(example: Path, tmp_path: Path) -> None:
    with served(example):
        copy = shutil.copytree(example, tmp_path / "copy")
        assert place.find(example) is not None
        assert place.find(copy) is None


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
