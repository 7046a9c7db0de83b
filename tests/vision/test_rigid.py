"""Rigid motions: turns never mirror, and what is fitted to points is the motion that brought them there."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.model.pose import Pose, angle_between
from pico.vision.rigid import (
    apart,
    best_motion,
    motion,
    moved,
    planar,
    rotation,
    rotation_vector,
    square,
    tilt,
    upright,
)

angles = st.floats(-3.1, 3.1)
vectors = st.tuples(angles, angles, angles).map(np.array).filter(lambda v: np.linalg.norm(v) < 3.1)
shifts = st.tuples(*(st.floats(-500, 500),) * 3).map(np.array)


@given(vectors)
@settings(max_examples=50, deadline=None)
def test_a_rotation_turns_about_its_vector_by_its_length(vector: np.ndarray) -> None:
    turn = rotation(vector)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9) and np.linalg.det(turn) == pytest.approx(1)
    assert turn @ vector == pytest.approx(vector, abs=1e-9)
    assert np.trace(turn) == pytest.approx(1 + 2 * math.cos(np.linalg.norm(vector)), abs=1e-9)
    assert rotation_vector(turn) == pytest.approx(vector, abs=1e-6)


def test_rotations_are_right_handed() -> None:
    assert rotation(np.array([0, 0, math.pi / 2])) @ (1, 0, 0) == pytest.approx((0, 1, 0), abs=1e-12)
    assert rotation(np.array([1e-12, 0, 0])) == pytest.approx(np.eye(3))


@given(vectors, shifts, st.integers(0, 1000))
@settings(max_examples=50, deadline=None)
def test_the_motion_between_two_sets_of_points_is_found(vector: np.ndarray, shift: np.ndarray, seed: int) -> None:
    true = motion(rotation(vector), shift)
    points = np.random.default_rng(seed).normal(0, 50, (5, 3))
    for cloud in (points, square(24.0)):
        found = best_motion(cloud, cloud @ true[:3, :3].T + true[:3, 3])
        assert found == pytest.approx(true, abs=1e-6)


@given(st.integers(0, 1000))
@settings(max_examples=20, deadline=None)
def test_points_seen_mirrored_are_fitted_by_a_turn_all_the_same(seed: int) -> None:
    points = np.random.default_rng(seed).normal(0, 50, (6, 3))
    turn = best_motion(points, points * (1, 1, -1))[:3, :3]
    assert np.linalg.det(turn) == pytest.approx(1) and turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9)


def test_the_fit_is_the_best_one_where_points_are_noisy() -> None:
    rng = np.random.default_rng(1)
    points = square(24.0)
    seen = points + rng.normal(0, 0.3, (4, 3))
    best = best_motion(points, seen)

    def left(pose: np.ndarray) -> float:
        return float(np.sum((points @ pose[:3, :3].T + pose[:3, 3] - seen) ** 2))

    for change in np.vstack((np.eye(6), -np.eye(6))) * 0.01:
        assert left(moved(best, change)) > left(best)


def test_a_pose_is_moved_in_the_axes_of_the_frame_about_its_own_place() -> None:
    pose = upright(Pose(100, 200, 90), 50)
    found = moved(pose, np.array([1, 2, 3, 0, 0, math.radians(30)]))
    assert found[:3, 3] == pytest.approx((101, 202, 53))
    assert planar(found).yaw == pytest.approx(120)
    assert apart(pose, found) == (pytest.approx(math.sqrt(14)), pytest.approx(30))
    leaning = moved(pose, np.array([0, 0, 0, math.radians(20), 0, 0]))
    assert (tilt(pose), tilt(leaning)) == (pytest.approx(0, abs=1e-5), pytest.approx(20))


@given(st.floats(-800, 800), st.floats(-800, 800), st.floats(-179, 180), st.floats(-50, 300))
@settings(max_examples=50, deadline=None)
def test_what_stands_upright_is_seen_from_above_where_it_stands(x: float, y: float, yaw: float, z: float) -> None:
    pose = upright(Pose(x, y, yaw), z)
    seen = planar(pose)
    assert (seen.x, seen.y, pose[2, 3]) == (x, y, z) and abs(angle_between(seen.yaw, yaw)) < 1e-9
    assert tilt(pose) == pytest.approx(0)


def test_the_corners_of_a_marker_run_clockwise_from_the_upper_left() -> None:
    assert square(20.0).tolist() == [[-10, 10, 0], [10, 10, 0], [10, -10, 0], [-10, -10, 0]]
