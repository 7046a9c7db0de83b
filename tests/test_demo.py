"""The demonstration restores two experiments by friction alone, and fails where there is none."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

DEMO = Path(__file__).resolve().parent.parent / "examples/demo.py"


def demonstrate(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(DEMO), "--folder", str(folder), *arguments]
    return subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)


@pytest.mark.slow
def test_it_restores_both_experiments_and_draws_them(tmp_path: Path) -> None:
    done = demonstrate(tmp_path / "bench")
    assert done.returncode == 0, done.stdout
    assert "of commit E2-1." in done.stdout
    assert "of commit E1-1." in done.stdout
    assert (tmp_path / "bench" / "E1-1.png").stat().st_size > 50_000


@pytest.mark.slow
def test_without_friction_it_fails_and_says_what_was_dropped(tmp_path: Path) -> None:
    done = demonstrate(tmp_path / "bench", "--friction", "0")
    assert done.returncode == 1
    assert "dropped p2" in done.stdout
    assert "The demonstration failed" in done.stdout
