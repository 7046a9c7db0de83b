"""A checkout carries what it began on a bench that it shares, and all that ran on its own, whoever serves that."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

from pico.edge.network.remotes import Far, Remote, Remotes, keep
from pico.edge.network.session import begun
from pico.history.lab.folder import LabFolder
from pico.history.runs.uncommitted import _own
from pico.runs.journal import RunRecord


def test_the_bench_of_a_page_is_its_folders_own(case_study: Path, tmp_path: Path) -> None:
    root = Path(shutil.copytree(case_study, tmp_path / "shel"))
    far = Far(Remote("http://127.0.0.1:8700"), "shel", "bench1", root)
    folder = LabFolder(root, place=far)
    runs = [
        RunRecord(run=name, plan="", holder="", number=n, started_at="2026-01-01T00:00:00Z")
        for n, name in enumerate("ab")
    ]
    begun(far.folder, "a")
    keep(root, Remotes({"lab": far.remote}))
    assert [run.run for run in _own(folder, runs)] == ["a"]
    folder = LabFolder(root, place=replace(far, local="sim"))  # as `pico gui` serves it
    assert [run.run for run in _own(folder, runs)] == ["a", "b"]
