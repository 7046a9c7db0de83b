"""Files of runs are written once, whole, and below `runs/` only."""

from __future__ import annotations

from pathlib import Path

import pytest

from pico.diagnostics import PicoError
from pico.history.lab.run_files import run_trailers, write_once

PATH = "runs/2026/11/r1/run.json"


def refused(root: Path, name: str, data: bytes = b"x") -> str:
    with pytest.raises(PicoError) as caught:
        write_once(root, name, data)
    return caught.value.diagnostics[0].code


def test_what_is_there_is_never_overwritten(tmp_path: Path) -> None:
    assert write_once(tmp_path, PATH, b"{}").read_bytes() == b"{}"
    assert write_once(tmp_path, PATH, b"{}").read_bytes() == b"{}"
    assert refused(tmp_path, PATH, b"[]") == "run-exists"
    assert (tmp_path / PATH).read_bytes() == b"{}"
    assert [p.name for p in (tmp_path / PATH).parent.iterdir()] == ["run.json"]


def test_nothing_is_written_elsewhere(tmp_path: Path) -> None:
    root = tmp_path / "lab"
    root.mkdir()
    for name in ("../x", "runs/../../x", "/tmp/x", "state/x"):
        assert refused(root, name) == "outside"
    (root / "runs").symlink_to(tmp_path)
    assert refused(root, PATH) == "outside"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["lab"]


def test_trailers_name_each_run_and_each_plan_once() -> None:
    files = {f"runs/2026/11/r{n}/run.json": b'{"plan": "sha256:p"}' for n in (2, 1)}
    files |= {"runs/2026/11/r3/run.json": b"damaged", "runs/2026/11/r1/trace.jsonl": b""}
    assert run_trailers(files) == (
        ("Pico-Run", "r1"), ("Pico-Run", "r2"), ("Pico-Run", "r3"), ("Pico-Plan", "sha256:p"),
    )  # fmt: skip
