"""Injected errors of the cameras: as large as asked for, by seed, and nothing where nothing is asked for."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from physical import bench

from pico.cameras.errors import CameraShift, bumped, common_shifts, true_cameras, turned
from pico.model.setup import Setup
from pico.model.simulated import SimErrors
from pico.vision.camera import CameraModel
from pico.vision.nominal import camera_models, looking

ERRORS = SimErrors(camera_position=0.2, camera_rotation=0.05, focal_length=0.005)
SMALL = st.floats(-2.0, 2.0)
VECTOR = st.tuples(SMALL, SMALL, SMALL)


def apart(one: CameraModel, other: CameraModel) -> tuple[float, float, float]:
    """Return how far two cameras are from one another [mm], turned [deg], and the ratio of focal lengths less one."""
    turn = one.pose[:3, :3] @ other.pose[:3, :3].T
    angle = np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)))
    ratio = one.matrix[0, 0] / other.matrix[0, 0] - 1
    return float(np.linalg.norm(one.pose[:3, 3] - other.pose[:3, 3])), float(angle), float(ratio)


@given(st.integers(0, 10_000))
def test_cameras_are_wrong_by_what_is_asked_for(seed: int) -> None:
    setup = bench_once()
    nominal = camera_models(setup)
    for name, camera in true_cameras(setup, ERRORS, seed).items():
        distance, angle, ratio = apart(camera, nominal[name])
        assert distance == pytest.approx(0.2) and angle == pytest.approx(0.05, rel=1e-4)
        assert abs(ratio) == pytest.approx(0.005)
        assert camera.matrix[0, 2] == nominal[name].matrix[0, 2]


def test_no_errors_no_difference_and_every_camera_has_its_own() -> None:
    setup = bench_once()
    nominal, same = camera_models(setup), true_cameras(setup, SimErrors(), 3)
    assert all(np.allclose(same[n].pose, nominal[n].pose, atol=1e-12) for n in nominal)
    wrong, again, other = (true_cameras(setup, ERRORS, seed) for seed in (3, 3, 4))
    assert np.array_equal(wrong["left"].pose, again["left"].pose)
    assert not np.allclose(wrong["left"].pose, other["left"].pose)
    shifts = [wrong[n].pose[:3, 3] - nominal[n].pose[:3, 3] for n in ("left", "right")]
    assert not np.allclose(*shifts, atol=0.01)


@given(VECTOR, VECTOR)
def test_a_common_drift_leaves_the_cameras_as_they_are_to_one_another(
    shift: tuple[float, float, float], turn: tuple[float, float, float]
) -> None:
    cameras = camera_models(bench_once())
    drift = CameraShift(shift=shift, turn=turn)
    shifts = common_shifts(cameras, drift)
    assert shifts.keys() == {"left", "right"}
    moved = {n: bumped(cameras[n], by) for n, by in shifts.items()}
    between = [np.linalg.inv(c["left"].pose) @ c["right"].pose for c in (cameras, moved)]
    assert np.allclose(*between, atol=1e-9)
    motion = moved["left"].pose @ np.linalg.inv(cameras["left"].pose)
    assert np.allclose(motion[:3, :3], turned(turn), atol=1e-12) and np.allclose(motion[:3, 3], shift, atol=1e-9)


@given(VECTOR)
def test_a_rotation_vector_is_its_axis_and_angle(vector: tuple[float, float, float]) -> None:
    turn = turned(vector)
    assert np.allclose(turn @ turn.T, np.eye(3)) and np.linalg.det(turn) == pytest.approx(1)
    assert np.allclose(turn @ vector, vector)
    assert np.trace(turn) == pytest.approx(1 + 2 * np.cos(np.radians(np.linalg.norm(vector))))


def test_a_camera_looks_where_it_should_and_rolls_clockwise() -> None:
    pose = looking((100, 200, 1000), (100, 200, 0))
    assert pose[:3, 2] == pytest.approx((0, 0, -1)) and pose[:3, 0] == pytest.approx((1, 0, 0))
    rolled = looking((100, 200, 1000), (100, 200, 0), 90)
    assert rolled[:3, 0] == pytest.approx((0, -1, 0))  # its right side now points to the front of the table


def bench_once() -> Setup:
    """Return the bench of the case study, read once."""
    return _BENCH


_BENCH = bench()
