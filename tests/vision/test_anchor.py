"""A camera that is wrong is put right by the datums in its own picture."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.cameras.errors import true_cameras
from pico.manifest.load import load_folder
from pico.model.setup import Setup
from pico.model.simulated import SimErrors
from pico.vision.anchor import SHARED, anchored
from pico.vision.datums import datum_corners
from pico.vision.markers import Markers, read_marker
from pico.vision.nominal import camera_models
from pico.vision.rigid import apart

SHEL = Path(__file__).resolve().parent.parent.parent / "labs" / "shel"
PLATES = np.array([(x, y, 140.0) for x in (150.0, 600.0, 1050.0) for y in (150.0, 450.0, 750.0)])


@pytest.fixture(scope="module")
def setup() -> Setup:
    return load_folder(SHEL).require()[0]


def off(camera, true) -> float:  # type: ignore[no-untyped-def]
    """How far beside a plate the ray of a camera passes that sees it where the true one does, at most [mm]."""
    origin, along = camera.rays(true.project(PLATES))
    there = origin + along * ((140.0 - origin[2]) / along[:, 2])[:, None]
    return float(np.abs(there - PLATES).max())


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_what_is_wrong_after_calibration_is_found_in_the_picture(setup: Setup, seed: int) -> None:
    errors = SimErrors(camera_position=0.2, camera_rotation=0.05, focal_length=0.005)
    true, believed = true_cameras(setup, errors, seed)["left"], camera_models(setup)["left"]
    noise = np.random.default_rng(seed)
    seen = [
        read_marker(d.marker, true.project(datum_corners(d)) + noise.normal(0, 0.05, (4, 2)), "left")
        for d in setup.lab.datums.values()
    ]
    right = anchored(setup, believed, Markers("left", tuple(seen)))
    assert off(believed, true) > 1.0
    assert off(right, true) < 0.2


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_a_longer_lens_is_not_taken_for_a_camera_that_was_bumped(setup: Setup, seed: int) -> None:
    errors = SimErrors(camera_position=0.2, camera_rotation=0.05, focal_length=0.005)
    true, believed = true_cameras(setup, errors, seed)["left"], camera_models(setup)["left"]
    noise = np.random.default_rng(seed)
    seen = []
    for datum in setup.lab.datums.values():
        off_together, each = noise.normal(0, SHARED, 2), noise.normal(0, 0.01, (4, 2))
        corners = true.project(datum_corners(datum)) + off_together + each
        seen.append(read_marker(datum.marker, corners, "left", noise=0.01))
    shift, turn = apart(believed.pose, anchored(setup, believed, Markers("left", tuple(seen)), together=SHARED).pose)
    assert shift < 0.6 and turn < 0.15


def test_two_datums_change_nothing(setup: Setup) -> None:
    believed = camera_models(setup)["left"]
    two = [read_marker(d.marker, believed.project(datum_corners(d)), "left") for d in setup.lab.datums.values()][:2]
    moved = replace(believed, pose=believed.pose @ np.diag([1.0, 1.0, 1.0, 1.0]))
    assert anchored(setup, moved, Markers("left", tuple(two))) is moved
