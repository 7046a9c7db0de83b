"""Pictures to identities and poses: what is certain has a pose, everything else is said."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.localize import localize
from painted import Painted, bumped, picture, plate_of, scattered, scene, setup, stereo

from pico.model.pose import Pose, angle_between
from pico.vision.calibration import Accuracy, Calibration
from pico.vision.frame import Frame
from pico.vision.markers import detect
from pico.vision.rigid import motion, rotation, upright
from pico.vision.sighting import Sighting

BENCH = setup(8)
CAMERAS = stereo(distortion=(-0.12, 0.05, 0.0005, -0.0003, 0.0))


def look(plates: list[Painted], cameras=CAMERAS, only=("left", "right"), true=None) -> Sighting:
    rng = np.random.default_rng(5)
    frames = [picture((true or cameras)[name], plates, rng) for name in only]
    return localize(BENCH, frames, Calibration(cameras))


@pytest.fixture
def poses() -> dict[str, Pose]:
    return scattered(BENCH, np.random.default_rng(3))


@pytest.mark.parametrize(
    ("only", "how", "worst"), [(("left", "right"), "stereo", 0.03), (("left",), "known height", 0.25)]
)
def test_every_part_is_seen_where_it_stands(poses: dict[str, Pose], only, how: str, worst: float) -> None:
    seen = look(scene(BENCH, poses), only=only)
    assert seen.components.keys() == poses.keys()
    assert seen.findings == ()
    assert set(seen.checked) == set(only)
    for name, part in seen.components.items():
        assert part.how == how
        assert part.pose.distance(poses[name]) < worst
        assert abs(angle_between(part.pose.yaw, poses[name].yaw)) < 0.12


def test_the_stated_uncertainty_covers_the_error(poses: dict[str, Pose]) -> None:
    rng, none = np.random.default_rng(8), Accuracy(position=0, yaw=0)
    shares, turns = [], []
    for _ in range(3):
        frames = [picture(camera, scene(BENCH, poses), rng) for camera in CAMERAS.values()]
        seen = localize(BENCH, frames, Calibration(CAMERAS, none))
        for name, part in seen.components.items():
            shares.append(part.pose.distance(poses[name]) / part.uncertainty.position / math.sqrt(2))
            turns.append(angle_between(part.pose.yaw, poses[name].yaw) / part.uncertainty.yaw)
    assert 0.3 < np.sqrt(np.mean(np.square(shares))) < 1.7
    assert 0.4 < np.sqrt(np.mean(np.square(turns))) < 1.7


def test_a_number_that_is_on_the_table_twice_has_no_pose(poses: dict[str, Pose]) -> None:
    copy = replace(plate_of(BENCH, "part_2", poses["part_5"]), number=2)
    seen = look([p for p in scene(BENCH, poses) if p.number != 5] + [copy])
    assert "part_2" not in seen.components
    (finding,) = seen.of("duplicate")
    assert finding.component == "part_2" and len(finding.at) == 2
    assert [f.component for f in seen.of("hidden")] == ["part_5"]


def test_one_number_at_two_places_in_two_pictures_is_a_conflict(poses: dict[str, Pose]) -> None:
    rng = np.random.default_rng(1)
    other = replace(plate_of(BENCH, "part_2", poses["part_5"]), number=2)
    without = [p for p in scene(BENCH, poses) if p.number not in (2, 5)]
    frames = [
        picture(CAMERAS["left"], [*without, plate_of(BENCH, "part_2", poses["part_2"])], rng),
        picture(CAMERAS["right"], [*without, other], rng),
    ]
    seen = localize(BENCH, frames, Calibration(CAMERAS))
    assert "part_2" not in seen.components
    assert {f.kind for f in seen.findings if f.component == "part_2"} <= {"conflict", "height", "tilted"}
    assert any(f.component == "part_2" for f in seen.findings)


def test_an_unknown_marker_is_a_stranger_with_its_place(poses: dict[str, Pose]) -> None:
    stray = replace(plate_of(BENCH, "part_1", Pose(480, 340, 12)), number=77)
    poses = {n: p for n, p in poses.items() if p.distance(Pose(480, 340)) > 60}
    seen = look([*scene(BENCH, poses), stray])
    stranger = seen.unknown["unknown/77"]
    assert stranger.pose.distance(Pose(480, 340)) < 0.1
    assert stranger.height == pytest.approx(140, abs=0.2) and stranger.size == pytest.approx(24, abs=0.1)
    assert [f.marker for f in seen.of("unknown")] == [77]


@pytest.mark.parametrize("cover", [*(pytest.param(c, marks=pytest.mark.slow) for c in (-8.0, 5.0)), -3.0, 0.0])
def test_a_marker_that_is_covered_in_part_is_never_guessed(poses: dict[str, Pose], cover: float) -> None:
    plates = [replace(p, covered=cover) if p.number == 3 else p for p in scene(BENCH, poses)]
    seen = look(plates)
    assert "part_3" not in seen.components
    assert not seen.unknown
    assert any(f.component == "part_3" for f in seen.of("hidden"))


@pytest.mark.parametrize("angle", [4.0, pytest.param(20.0, marks=pytest.mark.slow), 50.0])
def test_a_part_that_leans_has_no_pose(poses: dict[str, Pose], angle: float) -> None:
    plates = scene(BENCH, poses)
    leaning = next(p for p in plates if p.number == 4)
    turn = rotation(np.radians([angle, 0, 0])) @ leaning.pose[:3, :3]
    plates[plates.index(leaning)] = replace(leaning, pose=motion(turn, leaning.pose[:3, 3]))
    seen = look(plates)
    assert "part_4" not in seen.components
    assert seen.toppled == ("part_4",)
    assert "tilted" in seen.of("tilted")[0].text


def test_a_plate_at_another_height_is_not_the_part(poses: dict[str, Pose]) -> None:
    plates = scene(BENCH, poses)
    low = next(p for p in plates if p.number == 6)
    plates[plates.index(low)] = replace(low, pose=motion(low.pose[:3, :3], low.pose[:3, 3] - (0, 0, 10)))
    seen = look(plates)
    assert "part_6" not in seen.components
    assert "130.0 mm" in seen.of("height")[0].text


def test_a_marker_printed_at_another_scale_is_said_to_be(poses: dict[str, Pose]) -> None:
    plates = [replace(p, size=22.8) if p.number == 6 else p for p in scene(BENCH, poses)]
    seen = look(plates)
    assert "22.8 mm" in seen.of("size")[0].text
    assert seen.components["part_6"].pose.distance(poses["part_6"]) < 0.05


def test_a_camera_that_was_bumped_is_named_and_nothing_is_healed(poses: dict[str, Pose]) -> None:
    true = {**CAMERAS, "right": bumped(CAMERAS["right"], (2.0, 2.0, 1.0))}
    seen = look(scene(BENCH, poses), true=true)
    (drift,) = seen.drift
    assert drift.camera == "right" and drift.shift == pytest.approx(3.0, abs=0.5)
    assert not seen.trusted and seen.checked == ("left",)
    assert "pico calibrate" in seen.diagnostics()[0].hint


def test_a_loose_datum_is_no_drift(poses: dict[str, Pose]) -> None:
    plates = scene(BENCH, poses)
    loose = next(p for p in plates if p.number == 991)
    plates[plates.index(loose)] = replace(loose, pose=motion(loose.pose[:3, :3], loose.pose[:3, 3] + (4, 0, 0)))
    seen = look(plates)
    assert seen.trusted
    assert all("d2" in f.text for f in seen.of("datum")) and seen.of("datum")


def test_a_black_picture_is_said_to_be_black(poses: dict[str, Pose]) -> None:
    rng = np.random.default_rng(2)
    black = Frame(np.zeros((960, 1280), np.uint8), (0, 0), "left", 0.0)
    seen = localize(BENCH, [black, picture(CAMERAS["right"], scene(BENCH, poses), rng)], Calibration(CAMERAS))
    assert seen.dark == ("left",) and seen.of("dark")
    assert {part.how for part in seen.components.values()} == {"known height"}


def test_a_part_of_the_sensor_gives_the_same_pose(poses: dict[str, Pose]) -> None:
    rng = np.random.default_rng(2)
    frames = []
    for camera in CAMERAS.values():
        whole = picture(camera, scene(BENCH, poses), rng)
        u, v = (int(a) for a in camera.project(np.array([[poses["part_1"].x, poses["part_1"].y, 140.0]]))[0])
        left, top = max(u - 60, 0), max(v - 60, 0)
        frames.append(Frame(whole.gray[top : v + 60, left : u + 60], (left, top), camera.name, 0.0))
    seen = localize(BENCH, frames, Calibration(CAMERAS))
    assert seen.components["part_1"].pose.distance(poses["part_1"]) < 0.03


@pytest.mark.parametrize("covered", [-14.0, -13.0])
def test_what_lies_over_the_rim_of_a_plate_does_not_pull_its_marker(covered: float) -> None:
    camera, place = stereo()["left"], upright(Pose(480, 340, 25), 140)
    rng = np.random.default_rng(4)
    free, hidden = (
        detect(picture(camera, [Painted(5, place, 24.0, hides)], rng)).markers[0] for hides in (-1e9, covered)
    )
    assert np.abs(hidden.corners - free.corners).max() < 0.1
