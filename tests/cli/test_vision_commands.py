"""`pico calibrate markers` and `pico calibrate` from the command line."""

from __future__ import annotations

import json
import re
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
    lab = shel / "lab.yaml"
    lab.write_text(lab.read_text().replace("  seed: 1\n", "  seed: 1\n  errors: {arm: {mount_position: 2}}\n"))
    answer = pico("calibrate")
    assert answer.code == 0
    assert re.search(r"arm1 +mount off by \d\.\d+ mm, .*; its tool is known to 0\.\d+ mm", answer.out)
    written = json.loads((shel / "calibration/sim.json").read_text())
    assert written["schema"] == "pico.calibration/v2"
    assert {how["evidence"] for how in written["provenance"].values()} == {"simulated"}
    assert max(written["residuals"].values()) < 0.1
    assert written["arms"]["arm1"]["position"] < 0.1
    assert len(written["arms"]["arm1"]["offsets"]["zeros"]) == 7
