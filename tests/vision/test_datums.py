"""A camera that was bumped, a datum that came loose, and both: told apart by where four datums are seen."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from painted import DATUMS, bumped, setup, stereo

from pico.vision.calibration import Accuracy
from pico.vision.camera import CameraModel
from pico.vision.datums import check, datum_corners, offset, resection
from pico.vision.markers import Markers, read_marker
from pico.vision.rigid import apart
from pico.vision.sighting import CameraMoved, Finding

BENCH = setup(2)
CAMERA = stereo(distortion=(-0.12, 0.05, 0.0005, -0.0003, 0.0))["left"]
NAMES = sorted(DATUMS)


def picture(camera: CameraModel, names: list[str] = NAMES, **shifts: tuple[float, float]) -> Markers:
    """What a camera sees exactly of datums, some of them shifted [mm]."""
    found = []
    for name in names:
        corners = datum_corners(DATUMS[name]) + np.array((*shifts.get(name, (0.0, 0.0)), 0.0))
        found.append(read_marker(DATUMS[name].marker, camera.project(corners), camera.name))
    return Markers(camera.name, tuple(found))


def told(seen: Markers, accuracy: Accuracy = Accuracy()) -> tuple[CameraMoved | None, list[str]]:  # noqa: B008
    moved, findings = check(BENCH, seen, CAMERA, accuracy)
    return moved, [finding.text for finding in findings]


def test_where_all_datums_are_in_their_places_nothing_is_told() -> None:
    assert told(picture(CAMERA)) == (None, [])
    assert told(picture(CAMERA, **{NAMES[0]: (0.4, 0.0)})) == (None, [])


def test_a_bump_is_told_by_how_far_the_camera_went_and_what_that_does_on_the_table() -> None:
    true = bumped(CAMERA, (2.0, -1.0, 0.5), (0.3, 0.0, -0.2))
    moved, loose = told(picture(true))
    assert moved is not None and loose == [] and moved.camera == "left"
    shift, turn = apart(CAMERA.pose, true.pose)
    assert (moved.shift, moved.turn) == (pytest.approx(shift, abs=0.01), pytest.approx(turn, abs=1e-3))
    seen = {m.number: m for m in picture(true).markers}
    effects = [offset(d, CAMERA, seen[d.marker]) for d in DATUMS.values()]
    assert moved.effect == pytest.approx(max(effects)) and moved.effect > 2


@pytest.mark.parametrize("name", NAMES)
def test_a_datum_that_came_loose_is_named_with_its_distance(name: str) -> None:
    text = f"datum `{name}` is seen 5.0 mm from its place by `left`, and the other datums are not"
    assert told(picture(CAMERA, **{name: (4.0, 3.0)})) == (None, [text])


@pytest.mark.parametrize("name", NAMES)
def test_in_a_bumped_camera_the_datum_that_does_not_follow_the_others_is_named(name: str) -> None:
    true = bumped(CAMERA, (3.0, 0.0, 0.0), (0.2, 0.2, 0.0))
    moved, loose = told(picture(true, **{name: (-25.0, 10.0)}))
    assert moved is not None and [text.split("`")[1] for text in loose] == [name]
    assert moved.shift == pytest.approx(apart(CAMERA.pose, true.pose)[0], abs=0.02)


def test_with_fewer_than_three_datums_nothing_can_be_told() -> None:
    says = "`left` sees 2 of 4 datums, so it can't be told whether it has moved since it was calibrated"
    true = bumped(CAMERA, (5.0, 0.0, 0.0))
    assert told(picture(true, NAMES[:2])) == (None, [says])
    assert told(picture(true, NAMES[:3]))[0] is not None
    both = picture(true).markers
    assert told(Markers("left", (*both, *both[:2]))) == (None, [says]), "what is seen twice is not one of them"
    bare = replace(BENCH, lab=replace(BENCH.lab, datums={}))
    (none,) = check(bare, picture(true), CAMERA, Accuracy())[1]
    assert none == Finding(kind="datums", text="`left` sees no datums: the lab has none, so it can't be told whether "
                           "it has moved since it was calibrated")  # fmt: skip


def test_what_a_worse_calibration_leaves_open_is_no_bump() -> None:
    true = bumped(CAMERA, (1.5, 0.0, 0.0))
    assert told(picture(true))[0] is not None
    assert told(picture(true), Accuracy(position=0.5)) == (None, [])


def test_a_camera_is_found_where_exact_points_put_it() -> None:
    true = bumped(CAMERA, (4.0, -3.0, 6.0), (0.4, -0.3, 0.5))
    points = np.concatenate([datum_corners(d) for d in DATUMS.values()])
    found = resection(points, true.project(points), CAMERA)
    assert apart(found.pose, true.pose) == (pytest.approx(0, abs=1e-4), pytest.approx(0, abs=1e-5))
    assert found.residual < 1e-4
    off = true.project(points) + np.tile(((0.5, 0.0), (-0.5, 0.0)), (len(points) // 2, 1))
    assert resection(points, off, CAMERA).residual == pytest.approx(0.5, rel=0.2)


def test_a_lens_bends_as_opencv_says_and_rays_go_back_through_the_pixels() -> None:
    points = np.array([(x, y, z) for x in (100.0, 500.0, 900.0) for y in (50.0, 650.0) for z in (0.0, 150.0)])
    inverse = np.linalg.inv(CAMERA.pose)
    turn, _ = cv2.Rodrigues(inverse[:3, :3])
    want, _ = cv2.projectPoints(points, turn, inverse[:3, 3], CAMERA.matrix, CAMERA.distortion)
    pixels = CAMERA.project(points)
    assert pixels == pytest.approx(want.reshape(-1, 2), abs=1e-6)
    origin, along = CAMERA.rays(pixels)
    way = points - origin
    assert np.linalg.norm(along, axis=1) == pytest.approx(np.ones(len(points)))
    assert np.cross(way, along) == pytest.approx(np.zeros((len(points), 3)), abs=1e-2)
    assert origin == pytest.approx(CAMERA.pose[:3, 3])
