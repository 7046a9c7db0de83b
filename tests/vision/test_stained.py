"""Markers that light shines on, found where they are known to be; and what is not taken for one."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from painted import Painted, looking, picture

from pico.model.pose import Pose
from pico.vision.markers import detect, stained
from pico.vision.rigid import square, upright

NUMBER, SIZE = 7, 24.0
POSE = upright(Pose(0, 0, 25), 0.0)
CAMERA = looking("eye", (60, 10, 150), (0, 0, 0), (640, 480))
TRUE = CAMERA.project(square(SIZE) @ POSE[:3, :3].T + POSE[:3, 3])


@cache
def clean(number: int):  # type: ignore[no-untyped-def]
    """The marker without light on it."""
    return picture(CAMERA, [Painted(number, POSE, SIZE)], np.random.default_rng(number))


def lit(number: int, x: float, y: float, radius: float):  # type: ignore[no-untyped-def]
    """The marker with a disc of light over it: its middle in edges of the marker from the middle."""
    frame = clean(number)
    edge = np.linalg.norm(TRUE[0] - TRUE[1])
    v, u = np.indices(frame.gray.shape)
    middle = TRUE.mean(axis=0) + np.array((x, y)) * edge
    shine = 400 * np.exp(-((np.hypot(u - middle[0], v - middle[1]) / (radius * edge)) ** 4))
    return replace(frame, gray=np.clip(frame.gray + shine, 0, 255).astype(np.uint8))


@given(
    st.floats(-0.6, 0.6), st.floats(-0.6, 0.6), st.floats(0.05, 0.25), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)
)  # fmt: skip
@settings(max_examples=20, deadline=None)
def test_it_is_found_as_exactly_as_is_said_or_not_at_all(
    x: float, y: float, radius: float, dx: float, dy: float
) -> None:
    about = TRUE + np.array((dx, dy)) * np.linalg.norm(TRUE[0] - TRUE[1])
    found = stained(lit(NUMBER, x, y, radius), NUMBER, about)
    assert found is not None or radius > 0.15
    if found is not None:
        off = np.linalg.norm(found.corners.mean(axis=0) - TRUE.mean(axis=0))
        assert off < 0.1 and np.abs(found.corners - TRUE).max() < max(0.15, 3 * found.noise)


def test_a_disc_over_its_bits_hides_it_from_the_detector_only() -> None:
    frame = lit(NUMBER, 0.2, -0.2, 0.18)
    assert not detect(frame).markers and stained(frame, NUMBER, TRUE) is not None


@pytest.mark.parametrize("number", range(20, 40))
def test_another_marker_is_not_taken_for_it(number: int) -> None:
    assert stained(lit(number, 0.2, -0.2, 0.18), NUMBER, TRUE) is None


def test_what_is_covered_by_a_thing_is_not_read() -> None:
    covered = picture(CAMERA, [Painted(NUMBER, POSE, SIZE, covered=-3.0)], np.random.default_rng(1))
    assert stained(covered, NUMBER, TRUE) is None
