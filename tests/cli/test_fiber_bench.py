"""The ordinary week on a fiber coupling bench: align, commit, edit a wave plate, visit an older commit, come back."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from commanding import Pico, edit

LAB = Path(__file__).resolve().parents[1] / "labs" / "fiber"
SIM = "sim:\n  seed: 1\n  environment: none\n  errors: {seat: 1}\n"


@pytest.fixture
def fiber(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The fiber bench in a repository, its base state committed and applied, as the current directory."""
    root = shutil.copytree(LAB, tmp_path / "fiber")
    edit(root / "lab.yaml", "inventory:\n", f"{SIM}inventory:\n")
    edit(root / "state" / "table.yaml", "angle: 0}", "angle: 35}")
    for who in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{who}_NAME", "A Physicist")
        monkeypatch.setenv(f"GIT_{who}_EMAIL", "physicist@localhost")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
    monkeypatch.chdir(root)
    (root / ".gitignore").write_text(".pico/\n")
    subprocess.run(["git", "init", "-q", "-b", "main"], check=True)
    return root


def coupled(pico: Pico) -> float:
    """Return the power behind the fiber [mW]."""
    value: float = pico("measure", "fc.power", "--json").data["value"]
    return value


@pytest.mark.slow
def test_an_alignment_survives_an_edit_of_a_wave_plate_and_a_visit_to_an_older_commit(fiber: Path, pico: Pico) -> None:
    table = fiber / "state" / "table.yaml"
    assert pico("apply", "--yes").code == 0
    assert pico("commit", "-m", "base").code == 0
    assert pico("optimize", "coupling", "--yes").code == 0
    best = coupled(pico)
    assert best > 1, "mW of 2: it is met, or there is nothing to lose"
    answer = pico("commit", "-m", "aligned")
    assert answer.code == 0 and "Wrote the aligned values of coupling: m1.tilt" in answer.out
    assert "Nothing to capture" in pico("capture").out
    edit(table, "angle: 35", "angle: 30")
    told = " ".join(pico("plan").out.split())
    assert "align again: coupling (qwp.angle changes; met" in told and "`pico optimize coupling`" in told
    assert {op["component"] for op in pico("plan", "--json").data["operations"]} == {"qwp"}
    assert pico("apply", "--yes").code == 0
    assert coupled(pico) >= 0.97 * best
    assert pico("commit", "-m", "quarter-wave plate at 30 deg").code == 0
    subprocess.run(["git", "checkout", "-q", "HEAD~2"], cwd=fiber, check=True)
    assert pico("apply", "--yes").code == 0
    assert coupled(pico) >= 0.97 * best, "the mirrors were never met at 0"
    subprocess.run(["git", "checkout", "-q", "main"], cwd=fiber, check=True)
    assert pico("apply", "--align", "--yes").code == 0
    assert coupled(pico) >= 0.97 * best
