"""From corners in pictures to poses, with corners that are known exactly: no picture is drawn."""

from __future__ import annotations

import math

import cv2
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from painted import looking, stereo

from pico.model.catalog import MarkerPlate
from pico.model.pose import Pose, angle_between
from pico.vision.calibration import Accuracy
from pico.vision.camera import CameraModel
from pico.vision.judge import combined, judged
from pico.vision.markers import read_marker
from pico.vision.poses import (
    MarkerView,
    edge,
    flat_start,
    free,
    from_rays,
    on_plane,
    plane_points,
    straightened,
    triangulated,
)
from pico.vision.rigid import moved, planar, square, upright

SIZE, HEIGHT = 24.0, 140.0
BENT = (-0.2, 0.05, 0.001, -0.0005, 0.0)
LENSES = {"straight": stereo(), "bent": stereo(distortion=BENT)}
PLATE = MarkerPlate(size=SIZE, at=(0, 0, HEIGHT))
places = st.builds(Pose, st.floats(250, 750), st.floats(150, 550), st.floats(-179, 180))


def view(camera: CameraModel, pose: np.ndarray, size: float = SIZE, noise: float = 0.05, off: np.ndarray | float = 0.0):
    """Return a marker as a camera sees it: its corners where a plane's picture, laid through all of it, has them."""
    lines = np.linspace(-0.5, 0.5, 7) * size
    grid = np.array([(x, y, 0.0) for y in lines[::-1] for x in lines])
    laid, _ = cv2.findHomography(grid[:, :2], camera.project(grid @ pose[:3, :3].T + pose[:3, 3]))
    corners = cv2.perspectiveTransform(square(size)[:, None, :2], laid)[:, 0]
    return MarkerView(camera, read_marker(7, corners + off, camera.name, noise))


def views(lens: str, pose: np.ndarray, **rest: float) -> list[MarkerView]:
    return [view(camera, pose, **rest) for camera in LENSES[lens].values()]


@pytest.mark.parametrize("lens", LENSES)
@given(places)
@settings(max_examples=15, deadline=None)
def test_two_cameras_find_a_marker_exactly(lens: str, place: Pose) -> None:
    found = from_rays(views(lens, upright(place, HEIGHT)), SIZE)
    seen = planar(found.pose)
    assert seen.distance(place) < 2e-3 and abs(angle_between(seen.yaw, place.yaw)) < 1e-2
    assert found.height == pytest.approx(HEIGHT, abs=5e-3) and found.tilt < 0.02
    assert found.residual < 1e-3


@pytest.mark.parametrize("lens", LENSES)
@given(places)
@settings(max_examples=15, deadline=None)
def test_one_camera_that_knows_the_height_finds_a_marker_exactly(lens: str, place: Pose) -> None:
    found = on_plane([views(lens, upright(place, HEIGHT))[0]], SIZE, HEIGHT, 0.1, 0.1)
    seen = planar(found.pose)
    assert seen.distance(place) < 2e-3 and abs(angle_between(seen.yaw, place.yaw)) < 1e-2


def test_a_camera_that_knows_nothing_but_the_size_finds_how_a_marker_leans() -> None:
    camera = looking("near", (500, 100, 500), (500, 350, HEIGHT))
    pose = moved(upright(Pose(500, 350, 20), HEIGHT), np.array([0, 0, 0, math.radians(15), 0, 0]))
    found = free(view(camera, pose), SIZE, upright(Pose(502, 349, 18), HEIGHT))
    assert found.tilt == pytest.approx(15, abs=1e-2) and found.height == pytest.approx(HEIGHT, abs=1e-2)


@given(places)
@settings(max_examples=15, deadline=None)
def test_corners_that_a_plane_was_laid_through_are_put_where_the_lens_shows_them(place: Pose) -> None:
    camera, pose, size = LENSES["bent"]["left"], upright(place, HEIGHT), 60.0
    true = camera.project(square(size) @ pose[:3, :3].T + pose[:3, 3])
    laid = view(camera, pose, size)
    assert straightened(laid, size, pose).marker.corners == pytest.approx(true, abs=1e-6)


def test_without_a_lens_that_bends_corners_stay() -> None:
    laid = view(LENSES["straight"]["left"], upright(Pose(400, 300), HEIGHT))
    assert straightened(laid, SIZE, upright(Pose(400, 300), HEIGHT)) is laid


def test_a_height_that_is_not_known_well_gives_way_to_the_picture() -> None:
    """The marker stands 3 mm higher than is said, off to the side of the camera."""
    place = Pose(700, 500, 10)
    one = views("straight", upright(place, HEIGHT + 3))[0]
    errors = [planar(on_plane([one], SIZE, HEIGHT, sigma, 0.01).pose).distance(place) for sigma in (0.01, 30.0)]
    assert errors[0] > 0.8 and errors[1] < 0.1


def test_rays_of_two_cameras_meet_in_the_corners() -> None:
    pose = upright(Pose(420, 310, 33), HEIGHT)
    points = triangulated(views("straight", pose))
    assert points == pytest.approx(square(SIZE) @ pose[:3, :3].T + pose[:3, 3], abs=1e-4)
    assert edge(points) == pytest.approx(SIZE)


def test_rays_of_one_camera_end_where_a_plane_is() -> None:
    pose = upright(Pose(420, 310, 33), 80.0)
    one = views("straight", pose)[0]
    assert plane_points(one, 80.0) == pytest.approx(square(SIZE) @ pose[:3, :3].T + pose[:3, 3], abs=1e-4)
    assert flat_start(one, SIZE, 80.0) == pytest.approx(pose, abs=1e-4)


def test_the_uncertainty_grows_with_the_noise_and_is_that_of_many_trials() -> None:
    place, rng = Pose(450, 300, 25), np.random.default_rng(2)
    pose = upright(place, HEIGHT)
    trials = [
        planar(
            from_rays(
                [view(c, pose, noise=0.2, off=rng.normal(0, 0.2, (4, 2))) for c in LENSES["straight"].values()], SIZE
            ).pose
        )
        for _ in range(60)
    ]
    stated = from_rays(views("straight", pose, noise=0.2), SIZE)
    spread = max(np.std([t.x for t in trials]), np.std([t.y for t in trials]))
    assert 0.7 < spread / stated.uncertainty.position < 1.3
    assert 0.7 < np.std([angle_between(t.yaw, place.yaw) for t in trials]) / stated.uncertainty.yaw < 1.3
    finer = from_rays(views("straight", pose, noise=0.1), SIZE)
    for name in ("height_sigma", "tilt_sigma"):
        assert getattr(stated, name) == pytest.approx(2 * getattr(finer, name))


def test_what_the_calibration_does_not_know_is_part_of_the_uncertainty() -> None:
    found = from_rays(views("straight", upright(Pose(450, 300), HEIGHT)), SIZE)
    noise, total = found.uncertainty, combined(found, Accuracy(position=3.0, yaw=2.0))
    assert total.position == pytest.approx(math.hypot(noise.position, 3.0))
    assert total.yaw == pytest.approx(math.hypot(noise.yaw, 2.0))


TRUE = upright(Pose(450, 300, 25), HEIGHT)


@pytest.mark.parametrize("cameras", [1, 2])
@pytest.mark.parametrize(("pose", "size", "kind"), [
    (TRUE, SIZE, None),
    (moved(TRUE, np.array([0, 0, 1.0, 0, 0, 0])), SIZE, None),
    (moved(TRUE, np.array([0, 0, 30.0, 0, 0, 0])), SIZE, "height"),
    (moved(TRUE, np.array([0, 0, -30.0, 0, 0, 0])), SIZE, "height"),
    (moved(TRUE, np.array([0, 0, 0, math.radians(40), 0, 0])), SIZE, "tilted"),
    (moved(TRUE, np.array([0, 0, 0, 0, math.radians(-40), 0])), SIZE, "tilted"),
])  # fmt: skip
def test_what_does_not_stand_as_its_type_says_is_told(cameras: int, pose: np.ndarray, size: float, kind: str) -> None:
    found = judged(views("straight", pose, size=size, noise=0.01)[:cameras], PLATE, Accuracy(), in_hand=False)
    assert (found.kind, found.how) == (kind, "stereo" if cameras == 2 else "known height")
    assert (found.estimate is None) == (kind is not None)


@given(places, places)
@example(Pose(250, 150, 0), Pose(515, 159, -124))
@settings(max_examples=25, deadline=None)
def test_one_number_at_two_places_is_never_one_marker(one: Pose, other: Pose) -> None:
    """Rays that part from one another come nearest behind the cameras."""
    assume(one.distance(other) > 20 and abs(angle_between(one.yaw, other.yaw)) > 5)
    left, right = LENSES["straight"].values()
    two = [view(left, upright(one, HEIGHT), noise=0.01), view(right, upright(other, HEIGHT), noise=0.01)]
    found = judged(two, PLATE, Accuracy(), in_hand=False)
    assert found.kind in ("conflict", "tilted", "height", "size")


def test_two_cameras_tell_a_plate_of_another_size_and_markers_that_are_not_one() -> None:
    large = judged(views("straight", TRUE, size=30.0, noise=0.01), PLATE, Accuracy(), in_hand=True)
    assert (large.kind, large.how, large.text) == ("size", "in hand", "measures 30.0 mm, its type has 24 mm")
    assert large.estimate is not None and planar(large.estimate.pose).distance(Pose(450, 300)) < 0.01
    left, right = LENSES["straight"].values()
    two = [view(left, TRUE, noise=0.01), view(right, moved(TRUE, np.array([0, 60.0, 0, 0, 0, 0])), noise=0.01)]
    apart = judged(two, PLATE, Accuracy(), in_hand=False)
    assert apart.kind == "conflict" and apart.estimate is None
    assert apart.text == "is seen at (450, 300) by `left` and at (450, 360) by `right`, which can't be one marker"
