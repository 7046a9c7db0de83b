"""Rays against optiland, Gaussian beams against finesse: by golden figures that those programs made.

`benchmarks/optics_references.py` makes the figures, and compares with the programs where they are installed.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from oracles.optics_references import BEAMS, RAYS, beam_of, traced

RAY_CASES = json.loads(RAYS.read_text())["cases"]
BEAM_CASES = json.loads(BEAMS.read_text())["cases"]


@pytest.mark.parametrize("case", RAY_CASES, ids=lambda case: case["name"])
def test_rays_are_those_of_optiland(case: dict[str, Any]) -> None:
    """Points, directions and optical paths at every surface, to 1e-6 mm."""
    wanted = np.array(case["figures"])
    assert wanted.shape == (len(case["surfaces"]), len(case["rays"]), 7)
    assert np.abs(traced(case) - wanted).max() < 1e-6  # false for the nan of a lost ray


@pytest.mark.parametrize("case", BEAM_CASES, ids=lambda case: case["name"])
def test_beams_are_those_of_finesse(case: dict[str, Any]) -> None:
    """q behind every step, in the plane of the folds and across it, to 1e-6 of it."""
    found = beam_of(case)
    assert len(found) == len(case["figures"]) == len(case["path"])
    for step, q, figures in zip(case["path"], found, case["figures"], strict=True):
        level, upright = complex(*figures[:2]), complex(*figures[2:])
        assert (q.level, q.upright) == pytest.approx((level, upright), rel=1e-6), step
