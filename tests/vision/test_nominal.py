"""Cameras as a lab describes them: where they look, and which way is up in their pictures."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.model.lab import Camera
from pico.vision.nominal import looking, nominal

heights = st.floats(300, 2000)
sides = st.floats(-900, 900)


@given(sides, sides, heights, st.floats(-170, 170))
@settings(max_examples=50, deadline=None)
def test_what_a_camera_looks_at_is_in_the_middle_of_its_picture(x: float, y: float, z: float, roll: float) -> None:
    camera = nominal("c", Camera(position=(x, y, z), look_at=(10, 20, 30), roll=roll, pixels=(640, 480)))
    assert camera.project(np.array([[10.0, 20.0, 30.0]])) == pytest.approx(np.array([[319.5, 239.5]]), abs=1e-6)
    turn = camera.pose[:3, :3]
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9) and np.linalg.det(turn) == pytest.approx(1)


@pytest.mark.parametrize(("position", "up"), [
    ((0, 0, 1000), (0, 1, 0)),
    ((0, -900, 1000), (0, 1, 0)),
    ((0, -1000, 900), (0, 0, 1)),
    ((1000, 0, 300), (0, 0, 1)),
    ((0, 1, -500), (0, 1, 0)),
])  # fmt: skip
def test_up_in_the_picture_is_away_from_the_front_for_steep_cameras_and_upward_for_others(position, up) -> None:
    camera = nominal("c", Camera(position=position, look_at=(0, 0, 0)))
    middle, above = camera.project(np.array([(0.0, 0, 0), up]))
    assert above[1] < middle[1] and above[0] == pytest.approx(middle[0], abs=1e-6)


def test_a_roll_turns_the_camera_clockwise_as_it_sees() -> None:
    right = np.array([[1.0, 0.0, 0.0]])
    plain, rolled = (nominal("c", Camera(position=(0, 0, 1000), look_at=(0, 0, 0), roll=r)) for r in (0.0, 90.0))
    assert (plain.project(right) - plain.project(right * 0))[0] == pytest.approx((plain.matrix[0, 0] / 1000, 0))
    assert (rolled.project(right) - rolled.project(right * 0))[0] == pytest.approx(
        (0, -plain.matrix[0, 0] / 1000), abs=1e-9
    )


def test_the_field_of_view_is_that_of_the_height_of_the_picture() -> None:
    camera = nominal("c", Camera(position=(0, 0, 1000), look_at=(0, 0, 0), field_of_view=90.0, pixels=(800, 600)))
    edge = camera.project(np.array([[0.0, 1000.0, 0.0]]))[0]
    assert edge == pytest.approx((399.5, 299.5 - 300.0))
    assert camera.matrix == pytest.approx(np.array([[300.0, 0.0, 399.5], [0.0, 300.0, 299.5], [0.0, 0.0, 1.0]]))
    assert looking((0, 0, 5), (0, 0, 0))[:3, 3] == pytest.approx((0, 0, 5))
