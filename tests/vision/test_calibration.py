"""Calibration finds what was injected, from pictures of the board and of the datums."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from painted import bumped, looking, setup, stereo

from pico.diagnostics import PicoError
from pico.model.pose import Pose
from pico.vision.arm import ArmOffsets, FoundArm
from pico.vision.bundle import bundle
from pico.vision.calibration import Calibration, calibration_digest, known_arms, read_calibration, write_calibration
from pico.vision.charuco import BOARD, BoardView, board_image, charuco, find_board
from pico.vision.datums import datum_corners
from pico.vision.frame import Frame
from pico.vision.hand_eye import hand_eye, park_martin
from pico.vision.markers import Markers, read_marker
from pico.vision.rigid import apart, motion, rotation, upright

BENCH = setup(2)
NOISE = 0.03  # pixels


def corners() -> np.ndarray:
    points = np.asarray(charuco(BOARD).getChessboardCorners(), float)
    return (points - (BOARD.size[0] / 2, BOARD.size[1] / 2, 0)) * (1, -1, 1)


def seen(camera, pose: np.ndarray, rng) -> BoardView:
    points = corners()
    pixels = camera.project(points @ pose[:3, :3].T + pose[:3, 3])
    return BoardView(camera.name, points, pixels + rng.normal(0, NOISE, pixels.shape))


def table(camera, rng) -> Markers:
    found = [
        read_marker(d.marker, camera.project(datum_corners(d)) + rng.normal(0, NOISE, (4, 2)), camera.name)
        for d in BENCH.lab.datums.values()
    ]
    return Markers(camera.name, tuple(found))


def board_picture(millimetres: float) -> Frame:
    """The upper part of the board, so many millimetres of it, on white paper."""
    print_ = board_image(BOARD, 4.0)[: round(4 * millimetres)]
    return Frame(np.pad(print_, 60, constant_values=255), (0, 0), "left", 0.0)


def test_one_row_of_corners_does_not_tell_how_the_board_leans() -> None:
    whole = find_board(board_picture(BOARD.size[1]))
    assert whole is not None and len(whole.corners) == 24
    row = board_picture(1.95 * BOARD.square)
    _, numbers, _, _ = cv2.aruco.CharucoDetector(charuco(BOARD)).detectBoard(row.gray)
    assert len(numbers) == 6
    assert find_board(row) is None


def test_pictures_that_no_lens_explains_are_refused() -> None:
    rng = np.random.default_rng(4)
    start = stereo()
    shots = [{n: seen(c, pose, rng) for n, c in start.items()} for pose in poses(rng, 8)]
    bent = [
        {n: replace(v, pixels=v.pixels + rng.normal(0, 6, v.pixels.shape)) for n, v in shot.items()} for shot in shots
    ]
    with pytest.raises(PicoError, match="no lens explains what camera `left` saw"):
        bundle(BENCH, bent, {n: table(c, rng) for n, c in start.items()}, start)


def poses(rng, count: int) -> list[np.ndarray]:
    return [
        motion(
            rotation(np.append(rng.uniform(-0.6, 0.6, 2), 0)) @ rotation(np.array([0, 0, rng.uniform(0, 6.28)])),
            rng.uniform((250, 150, 60), (750, 550, 400)),
        )
        for _ in range(count)
    ]


def test_fixed_cameras_are_found_where_they_were_put() -> None:
    rng = np.random.default_rng(1)
    start = stereo((2448, 2048))
    true = {n: bumped(c, rng.uniform(-3, 3, 3), rng.uniform(-0.5, 0.5, 3)) for n, c in start.items()}
    true = {n: replace(c, matrix=c.matrix * np.array([[1.005], [1.005], [1]])) for n, c in true.items()}
    shots = [{n: seen(c, pose, rng) for n, c in true.items()} for pose in poses(rng, 16)]
    found = bundle(BENCH, shots, {n: table(c, rng) for n, c in true.items()}, start)
    for name, camera in found.cameras.items():
        distance, angle = apart(camera.pose, true[name].pose)
        assert distance < 0.2 and angle < 0.02
        assert found.residuals[name] == pytest.approx(NOISE * 2**0.5, rel=0.2)
    left, right = (np.linalg.inv(c["left"].pose) @ c["right"].pose for c in (found.cameras, true))
    assert apart(left, right)[0] < 0.1


def test_too_few_pictures_and_datums_are_named() -> None:
    cameras = stereo()
    with pytest.raises(PicoError) as refused:
        bundle(BENCH, [], {n: Markers(n, ()) for n in cameras}, cameras)
    assert [d.code for d in refused.value.diagnostics] == ["calibration-board", "calibration-datums"] * 2


def glances(mount: np.ndarray, rng, count: int = 12) -> tuple[list[np.ndarray], np.ndarray]:
    board = upright(Pose(500, 300, 20), 0.0)
    eyes = [
        looking("hand", rng.uniform((400, 200, 250), (600, 400, 400)), rng.uniform((490, 290, 0), (510, 310, 0))).pose
        @ motion(rotation(np.array([0, 0, rng.uniform(-0.7, 0.7)])), np.zeros(3))
        for _ in range(count)
    ]
    return [eye @ np.linalg.inv(mount) for eye in eyes], board


def test_hand_eye_is_exact_where_poses_are() -> None:
    mount = motion(rotation(np.array([0.1, -0.2, 1.5])), np.array([60.0, 5, -40]))
    tools, board = glances(mount, np.random.default_rng(4))
    found = park_martin(tools, [np.linalg.inv(tool @ mount) @ board for tool in tools])
    assert apart(found, mount) == pytest.approx((0, 0), abs=1e-6)


def test_hand_eye_finds_the_injected_mount_from_noisy_pictures() -> None:
    rng = np.random.default_rng(2)
    camera = replace(stereo((1280, 960))["left"], name="hand", robot="arm1")
    mount = motion(rotation(np.array([0.1, -0.2, 1.5])), np.array([60.0, 5, -40]))
    tools, board = glances(mount, rng)
    views = [seen(replace(camera, pose=tool @ mount), board, rng) for tool in tools]
    found = hand_eye(views, tools, camera)
    distance, angle = apart(found.camera.pose, mount)
    assert distance < 0.1 and angle < 0.02


def test_a_hand_that_only_shifts_can_not_be_calibrated() -> None:
    tools = [motion(np.eye(3), np.array([10.0 * i, 0, 300])) for i in range(8)]
    with pytest.raises(PicoError, match="turned too little"):
        park_martin(tools, [np.linalg.inv(tool) for tool in tools])


def test_the_file_gives_the_calibration_back(tmp_path: Path) -> None:
    made = Calibration(stereo(distortion=(-0.1, 0.02, 0, 0, 0.001)), residuals={"left": 0.03}, made_at="2026-01-01")
    write_calibration(tmp_path, made)
    again = read_calibration(tmp_path)
    assert again is not None and again.digest == made.digest
    assert apart(again.cameras["left"].pose, made.cameras["left"].pose) == pytest.approx((0, 0), abs=1e-4)
    assert replace(made, made_at="later").digest == made.digest == calibration_digest(tmp_path)
    assert "arms" not in made.as_json() and known_arms(tmp_path) == {}
    offsets = ArmOffsets(shift=(1.0, -2.0, 0.5), zeros=(0.1, -0.1, 0.0, 0.0, 0.0, 0.0, 0.2))
    write_calibration(tmp_path, replace(made, arms={"arm1": FoundArm(offsets=offsets, position=0.04, turn=0.02)}))
    assert known_arms(tmp_path) == {"arm1": offsets} and calibration_digest(tmp_path) != made.digest


def test_a_file_that_is_no_calibration_is_refused(tmp_path: Path) -> None:
    (tmp_path / "calibration.json").write_text('{"schema": "other"}')
    with pytest.raises(PicoError, match="no calibration"):
        read_calibration(tmp_path)


def test_a_plan_records_the_calibration(tmp_path: Path) -> None:
    from pico.bench.bench import Bench, new_lab

    new_lab(tmp_path / "lab", "minimal")
    with Bench.open(tmp_path / "lab") as bench:
        assert bench.plan().calibration is None
        made = Calibration(stereo())
        write_calibration(bench.root, made)
        plan = bench.plan()
    assert plan.calibration == made.digest
    assert plan.sealed().digest == plan.digest
