"""A lens by pictures of the board and the place of its camera by datums are found within what is said of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from painted import bumped, looking, stereo
from test_calibration import BENCH, NOISE, glances, poses, seen, table

from pico.diagnostics import PicoError
from pico.vision.bundle import bundle
from pico.vision.datums import datums_in
from pico.vision.hand_eye import hand_eye, scattered
from pico.vision.lens import LENS, board_in, lens, lens_of, place_of
from pico.vision.rigid import apart, motion, moved, rotation, rotation_vector


def true_of(camera, rng):
    wrong = bumped(camera, 3 * rng.choice((-1, 1), 3) / 3**0.5, rng.choice((-1, 1), 3) / 3**0.5)
    matrix = camera.matrix * np.array([[1.005], [1.005], [1]])
    return replace(wrong, matrix=matrix, distortion=np.array([-0.09, 0.04, 3e-4, -2e-4, 0.0]))


def off_by(found, true) -> np.ndarray:
    """How far lens (9), place [mm] and turn [rad] are off."""
    turn = rotation_vector(found.pose[:3, :3] @ true.pose[:3, :3].T)
    return np.concatenate([lens(found) - lens(true), found.pose[:3, 3] - true.pose[:3, 3], turn])


def test_lens_and_place_are_found_within_their_error_bars() -> None:
    pulls = []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        start = stereo()["left"]
        true = true_of(start, rng)
        found = lens_of([seen(true, pose, rng) for pose in poses(rng, 14)], start)
        assert found.residual == pytest.approx(NOISE * 2**0.5, rel=0.25) and found.held_out < 1.5 * found.residual
        placed = place_of(BENCH, datums_in(BENCH, table(true, rng), found.camera), found.camera, found.sigmas)
        assert placed.residual < 0.1
        pulls.append(np.concatenate([(lens(found.camera) - lens(true)) / found.sigmas,
                                     off_by(placed.camera, true)[LENS:] / placed.sigmas[LENS:]]))  # fmt: skip
    pull = np.abs(pulls)
    assert pull.max() < 4.5 and np.mean(pull < 2) > 0.88
    assert np.std(pulls, axis=0)[:LENS].mean() > 0.6, "the error bars of a lens are no larger than they must be"


def test_cameras_that_see_board_and_datums_are_found_within_their_error_bars() -> None:
    pulls = []
    for seed in range(3):
        rng, start = np.random.default_rng(seed), stereo()
        true = {name: true_of(camera, rng) for name, camera in start.items()}
        shots = [{n: seen(c, pose, rng) for n, c in true.items()} for pose in poses(rng, 10)]
        found = bundle(BENCH, shots, {n: table(c, rng) for n, c in true.items()}, start)
        pulls += [off_by(found.cameras[n], c) / found.sigmas[n] for n, c in true.items()]
    assert np.abs(pulls).max() < 4.5 and np.mean(np.abs(pulls) < 2) > 0.85


def test_datums_that_are_seen_better_than_the_board_make_error_bars_smaller() -> None:
    """What the datums alone tell is as sure as they are seen, not as the board is, and each picture counts as it is."""
    pulls = []
    for seed in range(6):
        rng, start = np.random.default_rng((seed, 5)), stereo()
        true = {name: true_of(camera, rng) for name, camera in start.items()}
        shots = []
        for pose, blurred in zip(poses(rng, 10), rng.uniform(0.0, 0.1, 10), strict=True):
            views = {n: seen(c, pose, rng) for n, c in true.items()}
            worse = {n: v.pixels + rng.normal(0, blurred, v.pixels.shape) for n, v in views.items()}
            shots.append({n: replace(v, pixels=worse[n]) for n, v in views.items()})
        found = bundle(BENCH, shots, {n: table(c, rng, 0.015) for n, c in true.items()}, start)
        pulls += [off_by(found.cameras[n], c) / found.sigmas[n] for n, c in true.items()]
    off = np.array(pulls)
    assert np.abs(off).max() < 4.5 and np.mean(np.abs(off) < 2) > 0.85
    by_datums = [6, LENS + 3, LENS + 5]  # p1, turn about x and z
    assert np.sqrt(np.mean(off[:, by_datums] ** 2)) > 1 / 1.5, "no more than 1.5 times the scatter is said"


def test_too_few_pictures_and_pictures_that_no_lens_explains_are_named() -> None:
    rng, camera = np.random.default_rng(3), stereo()["left"]
    views = [seen(camera, pose, rng) for pose in poses(rng, 8)]
    with pytest.raises(PicoError, match="`left` sees the board in 5 pictures; 6 is the least"):
        lens_of(views[:5], camera)
    bent = [replace(view, pixels=view.pixels + rng.normal(0, 5, view.pixels.shape)) for view in views]
    with pytest.raises(PicoError, match="no lens explains what camera `left` saw"):
        lens_of(bent, camera)


def test_a_board_that_two_calibrated_cameras_see_is_found_on_the_table() -> None:
    rng, cameras = np.random.default_rng(5), stereo()
    for pose in poses(rng, 4):
        views = [seen(camera, pose, rng) for camera in cameras.values()]
        found, left = board_in(views, list(cameras.values()))
        distance, angle = apart(found, pose)
        assert distance < 0.1 and angle < 0.05 and left == pytest.approx(NOISE * 2**0.5, rel=0.3)


def test_one_camera_straight_above_says_how_badly_it_knows_what_stands_high() -> None:
    """Datums alone hardly tell its place from its principal point: what it then has wrong shows above the table."""
    off, said = [], []
    for seed in range(4):
        rng, start = np.random.default_rng((seed, 6)), {"top": looking("top", (500, 350, 1000), (500, 350, 0))}
        true = true_of(start["top"], rng)
        shots = [{"top": seen(true, pose, rng)} for pose in poses(rng, 10)]
        found = bundle(BENCH, shots, {"top": table(true, rng)}, start)
        points = np.array([(x, y, 140.0) for x in (150.0, 850.0) for y in (150.0, 550.0)])
        origin, ways = found.cameras["top"].rays(true.project(points))
        there = origin + ways * ((140.0 - origin[2]) / ways[:, 2])[:, None]
        off.append(np.sqrt(np.mean(np.sum((there - points)[:, :2] ** 2, axis=1))))
        said.append(found.position)
    assert np.sqrt(np.mean(np.square(off))) < 2.5 * np.mean(said), (off, said)
    assert min(said) > 0.05


def test_the_error_bars_of_a_camera_in_a_hand_hold_for_an_arm_that_is_not_where_it_says() -> None:
    """Each picture is off as a whole, by what the arm is off there."""
    mount, pulls, outs = motion(rotation(np.array([0.1, -0.2, 1.5])), np.array([60.0, 5, -40])), [], []
    camera = replace(stereo()["left"], name="hand", robot="arm1")
    for seed in range(3):
        rng = np.random.default_rng((seed, 8))
        tools, board = glances(mount, rng)
        sigmas = np.repeat((0.1, 2e-4), 3)
        there = [moved(tool, rng.normal(0, sigmas)) for tool in tools]
        views = [seen(replace(camera, pose=tool @ mount), board, rng) for tool in there]
        found = hand_eye(views, tools, camera, board)
        spread, out = scattered(views, tools, camera, board, found)
        true = replace(camera, pose=mount)
        pulls += list(off_by(found.camera, true) / spread)
        outs.append(out / found.residual)
    assert np.abs(pulls).max() < 5 and np.mean(np.abs(pulls) < 2) > 0.85
    assert np.sqrt(np.mean(np.square(pulls))) > 0.5 and min(outs) > 1
