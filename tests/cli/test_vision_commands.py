"""`pico calibrate markers` and `pico calibrate` from the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commanding import Pico


def test_markers_are_written_as_a_pdf(shel: Path, pico: Pico) -> None:
    answer = pico("calibrate", "markers", "--out", "m.pdf", "--paper", "letter")
    assert answer.code == 0 and "Print at 100 %" in answer.out
    assert (shel / "m.pdf").read_bytes().startswith(b"%PDF-1.4")
    assert pico("calibrate", "markers", "--paper", "a5").code == 1


@pytest.mark.slow
def test_calibration_is_written_with_its_residuals(shel: Path, pico: Pico) -> None:
    answer = pico("calibrate")
    assert answer.code == 0
    written = json.loads((shel / "calibration.json").read_text())
    assert written["schema"] == "pico.calibration/v1"
    assert max(written["residuals"].values()) < 0.1
