"""`pico optimize center PART CAMERA --by-arm`: what it says before it begins, and where the camera tells nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from commanding import Pico


@pytest.fixture
def minimal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, shel: Path, pico: Pico) -> Path:
    """The smallest example, its lens in the beam; git knows an author from `shel`."""
    monkeypatch.chdir(tmp_path)
    assert pico("init", "--example", "minimal", "minimal").code == 0
    monkeypatch.chdir(tmp_path / "minimal")
    assert pico("apply", "--yes").code == 0
    return tmp_path / "minimal"


def said(text: str) -> str:
    return " ".join(text.split())


def test_a_part_without_a_stage_leads_to_the_arm(minimal: Path, pico: Pico) -> None:
    assert "`pico optimize center lens camera --by-arm`" in pico("optimize", "center", "lens", "camera").err
    assert "--by-arm" not in pico("optimize", "focus", "lens", "camera").err, "the arm does not do that"
    ahead = pico("optimize", "center", "lens", "camera", "--by-arm", "--dry-run")
    assert ahead.code == 0 and "the arm puts lens down anew, 12 times at most" in said(ahead.out)
    assert "Nothing to do" not in ahead.out


def test_a_camera_that_no_exposure_helps_says_what_would(minimal: Path, pico: Pico) -> None:
    answer = pico("optimize", "center", "lens", "camera", "--by-arm", "--yes")
    assert answer.code == 6 and "Nothing to do" not in answer.out
    assert "saturated even at 0.02 ms" in said(answer.out) and "weaken the beam" in said(answer.out)
