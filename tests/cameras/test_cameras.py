"""What simulated cameras deliver: markers exactly where the camera model has them, what hides them, noise, depth."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from functools import cache

import cv2
import numpy as np
import pytest
from physical import bench

from pico.cameras.markers import pose_in_table
from pico.cameras.simulated import Eyes, clipped
from pico.cameras.stickers import Sticker, flat
from pico.diagnostics import PicoError
from pico.drawing.picture import pose_model
from pico.model.catalog import Footprint, Geometry
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.simulated import BadLight, SimErrors
from pico.twin.placement import Placement, upright
from pico.twin.scene import SceneBody, build_scene
from pico.vision.frame import Frame
from pico.vision.markers import detect

import mujoco  # isort: skip

DETECTOR = cv2.aruco.ArucoDetector(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_1000))


@cache
def quiet(blur: float = 0.7) -> Setup:
    """The bench of the case study with cameras that add no noise."""
    setup = bench()
    cameras = {name: replace(c, noise=0.0, blur=blur) for name, c in setup.lab.cameras.items()}
    return replace(setup, lab=replace(setup.lab, cameras=cameras))


def look(setup: Setup, places: dict[str, Placement], **options: object) -> Eyes:
    """Return the cameras of a bench with components at `places` and its arm parked."""
    things = {n: SceneBody(setup.type_of(n).geometry, p) for n, p in places.items() if n in setup.lab.inventory}
    box = Geometry(footprint=Footprint(box=(60, 60)), height=100, mass=1.0)
    things |= {n: SceneBody(box, p) for n, p in places.items() if n not in setup.lab.inventory}
    model = build_scene(setup, things).compile()
    data = mujoco.MjData(model)
    joints = {name: tuple(math.radians(a) for a in robot.park) for name, robot in setup.lab.robots.items()}
    pose_model(setup, model, data, {}, joints)
    return Eyes(setup, model, data, **options)  # type: ignore[arg-type]


def corners(eyes: Eyes, camera: str, sticker: Sticker) -> np.ndarray:
    """Return where the corners of a sticker are in a picture, by the camera model: clockwise from its upper left."""
    view = eyes._view(camera, None)
    _, pose = pose_in_table(view, sticker)
    h = sticker.size / 2
    square = np.array([(-h, h, 0), (h, h, 0), (h, -h, 0), (-h, -h, 0)])
    return eyes.placed(camera).project(square @ pose[:3, :3].T + pose[:3, 3])


def around(eyes: Eyes, camera: str, sticker: Sticker, room: float = 30) -> tuple[int, int, int, int]:
    """Return the region of the sensor around a sticker."""
    at = corners(eyes, camera, sticker)
    low, high = np.floor(at.min(axis=0) - room).astype(int), np.ceil(at.max(axis=0) + room).astype(int)
    return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])


def read(frame: Frame) -> dict[int, np.ndarray]:
    """Return the corners (4, 2) [pixels of the sensor] of the markers in a picture, refined."""
    quads, numbers, _ = DETECTOR.detectMarkers(frame.gray)
    found = {}
    for quad, number in zip(quads, [] if numbers is None else numbers.ravel(), strict=True):
        start = quad.reshape(-1, 1, 2).astype(np.float32)
        fine = cv2.cornerSubPix(frame.gray, start, (4, 4), (-1, -1), (3, 50, 1e-3))
        found[int(number)] = fine.reshape(4, 2) + np.array(frame.offset)
    return found


def sticker(eyes: Eyes, marker: int) -> Sticker:
    """Return the sticker with a number."""
    return next(s for s in eyes.stickers if s.marker == marker)


P1 = 2  # the marker of p1


@pytest.mark.parametrize("camera", ["left", "right"])
def test_markers_are_where_the_camera_model_has_them(camera: str) -> None:
    eyes = look(quiet(), {"p1": upright(Pose(300, 400, 20)), "p2": upright(Pose(900, 150, 130))})
    found = read(eyes.frame(camera))
    assert found.keys() == {P1, 3, *range(990, 996)}
    for number, seen in found.items():
        true = corners(eyes, camera, sticker(eyes, number))
        assert np.linalg.norm(seen.mean(axis=0) - true.mean(axis=0)) < 0.1, number
        assert np.abs(seen - true).max() < 0.4, number  # what the refinement of corners itself is off by


def test_a_pixel_is_the_mean_of_what_it_covers() -> None:
    """Against a picture of 144 points a pixel, drawn from the definition."""
    eyes = look(quiet(blur=0.0), {"p1": upright(Pose(300, 400, 20))})
    one, camera = sticker(eyes, P1), eyes.placed("left")
    frame = eyes.frame("left", around(eyes, "left", one, 0))
    u, v = frame.offset
    height, width = frame.gray.shape
    points = 12
    across = u - 0.5 + (np.arange(width * points) + 0.5) / points
    down = v - 0.5 + (np.arange(height * points) + 0.5) / points
    columns, rows = np.meshgrid(across, down)
    _, pose = pose_in_table(eyes._view("left", None), one)
    origin, rays = camera.rays(np.column_stack((columns.ravel(), rows.ravel())))
    inverse = np.linalg.inv(pose)
    start, ways = inverse[:3, :3] @ origin + inverse[:3, 3], rays @ inverse[:3, :3].T
    place = start[:2] - ways[:, :2] * (start[2] / ways[:, 2])[:, None]
    image = cv2.aruco.generateImageMarker(DETECTOR.getDictionary(), P1, 6)
    image = np.pad(image / 255, 1, constant_values=1.0)
    modules = np.column_stack((place[:, 0] / one.size * 6 + 4, 4 - place[:, 1] / one.size * 6))
    on_paper = np.all((modules > 0) & (modules < 8), axis=1)
    column, row = np.floor(modules).astype(int).clip(0, 7).T
    ink, inside = (
        a.reshape(height, points, width, points).mean(axis=(1, 3)) for a in (image[row, column], on_paper.astype(float))
    )
    within = inside == 1.0
    gray = frame.gray.astype(float)
    slope, offset = np.polyfit(ink[within], gray[within], 1)
    off = gray - slope * ink - offset
    assert within.mean() > 0.6
    assert np.sqrt(np.mean(off[within] ** 2)) < 0.02 * slope
    down_slope, across_slope = np.gradient(slope * ink)
    slopes = np.column_stack((across_slope[within], down_slope[within]))
    shift = np.linalg.lstsq(slopes, off[within], rcond=None)[0]
    assert np.abs(shift).max() < 0.01  # pixels


def test_a_region_shows_what_the_whole_picture_shows() -> None:
    eyes = look(quiet(), {"p1": upright(Pose(300, 400, 20))})
    region = around(eyes, "left", sticker(eyes, P1))
    part, whole = eyes.frame("left", region), eyes.frame("left")
    assert part.offset == region[:2] and part.gray.shape == region[3:1:-1]
    assert np.abs(read(part)[P1] - read(whole)[P1]).max() < 0.02


def test_a_region_is_clipped_to_the_sensor() -> None:
    assert clipped((-10, 2000, 100, 100), (2448, 2048)) == (0, 2000, 90, 48)
    with pytest.raises(ValueError, match="off a sensor"):
        clipped((3000, 0, 10, 10), (2448, 2048))


def test_a_tilted_part_shows_its_marker_tilted() -> None:
    half = math.radians(25) / 2
    tilted = Placement((0.5, 0.3, 0.03), (math.cos(half), math.sin(half), 0.0, 0.0))
    eyes = look(quiet(), {"p1": tilted})
    one = sticker(eyes, P1)
    seen = read(eyes.frame("right", around(eyes, "right", one)))[P1]
    assert np.abs(seen - corners(eyes, "right", one)).max() < 0.5


def test_what_lies_upside_down_shows_no_marker() -> None:
    eyes = look(quiet(), {"p1": Placement((0.5, 0.3, 0.2), (0.0, 1.0, 0.0, 0.0))})
    assert P1 not in read(eyes.frame("left", (0, 0, 2448, 2048)))


def test_bodies_hide_markers_and_parts_of_them() -> None:
    under = flat(500, 24, None, (300, 400, 0))  # below the base of p1
    half = flat(501, 24, None, (500, 300, 0))  # its left half below an object
    free = flat(502, 24, None, (700, 300, 0))
    places = {"p1": upright(Pose(300, 400, 0)), "unknown/600": upright(Pose(470, 300, 0))}
    eyes = look(quiet(), places, extra=(under, half, free))
    frame = eyes.frame("right")
    assert {500, 501} & read(frame).keys() == set() and 502 in read(frame)
    region = around(eyes, "right", half, 0)
    with_it = eyes.frame("right", region).gray
    without = look(quiet(), places).frame("right", region).gray
    changed = np.abs(with_it.astype(int) - without) > 20
    assert 0.1 < changed.mean() < 0.8


def test_the_arm_hides_what_is_below_it() -> None:
    below = flat(500, 24, None, (480, 700, 0))
    eyes = look(quiet(), {}, extra=(below,))
    assert 500 not in read(eyes.frame("left")) and 500 not in read(eyes.frame("right"))


def test_a_stranger_carries_the_marker_of_its_name_and_a_part_what_the_world_says() -> None:
    places = {"p1": upright(Pose(300, 400)), "p2": upright(Pose(500, 400)), "unknown/77": upright(Pose(700, 400))}
    eyes = look(quiet(), places, markers={"p1": 40, "p2": None})
    assert read(eyes.frame("left")).keys() == {40, 77, *range(990, 996)}


def test_two_of_the_same_number_are_both_there() -> None:
    twin = flat(P1, 24, None, (700, 300, 0))
    eyes = look(quiet(), {"p1": upright(Pose(300, 400))}, extra=(twin,))
    _, numbers, _ = DETECTOR.detectMarkers(eyes.frame("left").gray)
    assert list(numbers.ravel()).count(P1) == 2


def test_same_seed_same_pictures() -> None:
    setup, region = bench(), (1000, 1000, 200, 150)
    first, again, other = (look(setup, {}, seed=seed).frame("left", region).gray for seed in (1, 1, 2))
    assert np.array_equal(first, again) and not np.array_equal(first, other)


def test_noise_has_the_sigma_of_the_camera_times_the_injected_factor() -> None:
    region = (2300, 1000, 100, 100)  # the floor beside the table
    for factor in (1.0, 3.0):
        gray = look(bench(), {}, errors=SimErrors(noise=factor)).frame("left", region).gray
        assert gray.std() == pytest.approx(2.0 * factor, rel=0.1)


@pytest.mark.parametrize(
    ("light", "least"),
    [(BadLight(dim=0.25), 1.0), (BadLight(defocus=1.5), 0.9), (BadLight(scatter=60), 0.5), (BadLight(glare=40), 0.5)],
    ids=["dim", "out of focus", "scatter", "glare"],
)
def test_in_bad_light_markers_are_as_near_as_is_said_or_not_read(light: BadLight, least: float) -> None:
    """What falls on a marker in part pulls it by less than four of its standard deviations."""
    eyes = look(bench(), {"p1": upright(Pose(300, 400, 20))}, errors=SimErrors(light=light))
    known, looks = [sticker(eyes, number) for number in (P1, 991, 994)], 0
    seen = []
    for eyes._seed in range(12):
        for one in known:
            looks += 1
            for marker in detect(eyes.frame("left", around(eyes, "left", one))).markers:
                off = np.abs(marker.corners - corners(eyes, "left", one)).max()
                seen.append((off, marker.noise))
    assert len(seen) >= least * looks
    assert all(off < 4 * noise + 0.03 for off, noise in seen), max(seen)


def test_lost_frames_are_black_and_as_many_as_asked_for() -> None:
    eyes = look(bench(), {}, errors=SimErrors(lost_frames=0.3))
    black = [eyes.frame("left", (1000, 1000, 40, 40)).black for _ in range(200)]
    assert 30 <= sum(black) <= 95
    assert not any(look(bench(), {}).frame("left", (1000, 1000, 40, 40)).black for _ in range(3))


def test_marker_height_errors_raise_and_lower_the_print() -> None:
    places = {"p1": upright(Pose(300, 400)), "p2": upright(Pose(500, 400))}
    plain = look(quiet(), places)
    eyes = look(quiet(), places, errors=SimErrors(marker_height=0.5))
    heights = [a.pose[2][3] - b.pose[2][3] for a, b in zip(eyes.stickers, plain.stickers, strict=True)]
    assert 0.1 < float(np.std(heights)) < 1.0
    seen = read(eyes.frame("left"))
    assert {P1, 3} <= seen.keys()


def in_hand(setup: Setup, **options: object) -> Eyes:
    """Return the cameras of a bench with p1 in the hand of the parked arm, 100 mm of it below the tool's point."""
    parked = look(setup, {})
    x, y, z = parked.data.site_xpos[parked.model.site("arm1/tcp").id] * 1000
    return look(setup, {"p1": upright(Pose(x, y, 0), z - 100)}, **options)


def test_the_eye_in_the_hand_sees_the_plate_between_the_fingers() -> None:
    assert P1 in read(in_hand(quiet()).frame("hand"))


def test_depth_is_along_the_axis_with_noise_and_within_the_range() -> None:
    eyes = in_hand(bench())
    view = eyes._view("hand", None)
    plate = np.linalg.inv(view.camera.pose) @ pose_in_table(view, sticker(eyes, P1))[1]
    center = pose_in_table(view, sticker(eyes, P1))[1][:3, 3]
    u, v = np.rint(view.camera.project(center[None])[0]).astype(int)
    depth = eyes.depth("hand")
    patch = depth[v - 10 : v + 12, u - 10 : u + 11]
    assert depth.shape == (960, 1280)
    assert patch.mean() == pytest.approx(plate[2, 3], rel=0.001)
    assert 0.001 < (patch[1::2] / patch[::2] - 1).std() / math.sqrt(2) < 0.004  # sigma 0.002
    assert np.isnan(depth).any() and np.nanmin(depth) > 68 and np.nanmax(depth) < 510


def test_a_camera_without_depth_says_so() -> None:
    with pytest.raises(ValueError, match="left measures no depth"):
        look(bench(), {}).depth("left")


@pytest.mark.slow
def test_opengl_draws_the_same_markers_at_the_same_places() -> None:
    places = {"p1": upright(Pose(300, 400, 20)), "p2": upright(Pose(500, 300, 130))}
    try:
        eyes = look(quiet(), places, renderer="egl")
    except PicoError as missing:
        pytest.skip(missing.diagnostics[0].summary)
    for number in (P1, 3):
        one = sticker(eyes, number)
        seen = read(eyes.frame("left", around(eyes, "left", one)))[number]
        assert np.linalg.norm((seen - corners(eyes, "left", one)).mean(axis=0)) < 0.1
        assert np.abs(seen - corners(eyes, "left", one)).max() < 0.4


def test_opengl_that_is_not_there_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mujoco.egl", None)
    with pytest.raises(PicoError, match="this machine has no EGL"):
        look(quiet(), {}, renderer="egl")
