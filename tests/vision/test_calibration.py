"""Calibration finds what was injected, from pictures of the board and of the datums."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from painted import bumped, looking, setup, stereo

from pico.diagnostics import PicoError
from pico.model.calibration.results import AxisZero, DarkLevel, Provenance
from pico.model.calibration.steps import standing
from pico.model.instruments.conversion import conversion
from pico.model.pose import Pose
from pico.model.record import digest
from pico.model.wiring import Wired
from pico.vision.arm import ArmOffsets, FoundArm
from pico.vision.bundle import bundle
from pico.vision.calibration import Calibration
from pico.vision.calibration_files import (
    calibration_digest,
    known_arms,
    made_at,
    not_counting,
    other_devices,
    read_calibration,
    results_of,
    write_calibration,
)
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


def table(camera, rng, noise: float = NOISE) -> Markers:
    found = [
        read_marker(d.marker, camera.project(datum_corners(d)) + rng.normal(0, noise, (4, 2)), camera.name)
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
    write_calibration(tmp_path, "sim", made)
    again = read_calibration(tmp_path, "sim")
    assert again is not None and again.digest == made.digest
    assert apart(again.cameras["left"].pose, made.cameras["left"].pose) == pytest.approx((0, 0), abs=1e-4)
    assert replace(made, made_at="later").digest == made.digest == calibration_digest(tmp_path, "sim")
    assert "arms" not in made.as_json() and known_arms(tmp_path, "sim") == {}
    offsets = ArmOffsets(shift=(1.0, -2.0, 0.5), zeros=(0.1, -0.1, 0.0, 0.0, 0.0, 0.0, 0.2))
    write_calibration(
        tmp_path, "sim", replace(made, arms={"arm1": FoundArm(offsets=offsets, position=0.04, turn=0.02)})
    )
    assert known_arms(tmp_path, "sim") == {"arm1": offsets} and calibration_digest(tmp_path, "sim") != made.digest


def test_a_file_that_is_no_calibration_is_refused(tmp_path: Path) -> None:
    (tmp_path / "calibration.json").write_text('{"schema": "other"}')
    with pytest.raises(PicoError, match="no calibration"):
        read_calibration(tmp_path, "sim")


def test_a_plan_records_the_calibration(tmp_path: Path) -> None:
    from pico.bench.bench import Bench, new_lab

    new_lab(tmp_path / "lab", "minimal")
    with Bench.open(tmp_path / "lab") as bench:
        assert bench.plan().calibration is None
        made = Calibration(stereo())
        write_calibration(bench.root, "sim", made)
        plan = bench.plan()
    assert plan.calibration == made.digest
    assert plan.sealed().digest == plan.digest


def provenance(**said: object) -> Provenance:
    return replace(Provenance(bench="hardware", evidence="measured", at="2026-11-01T12:00:00Z"), **said)


def as_before() -> dict[str, object]:
    """A calibration as the first version of the format had it, with the digest that plans recorded of it."""
    document = Calibration(stereo(), residuals={"left": 0.03}, made_at="2026-11-01T12:00:00Z").as_json()
    del document["provenance"]
    return {**document, "schema": "pico.calibration/v1"}


def test_a_calibration_of_before_counts_as_simulated_and_keeps_its_digest(tmp_path: Path) -> None:
    before = as_before()
    (tmp_path / "calibration.json").write_text(json.dumps(before))
    found = read_calibration(tmp_path, "sim")
    assert found is not None and found.cameras.keys() == {"left", "right"}
    assert {how.evidence for how in found.provenance.values()} == {"simulated"}
    recorded = digest({key: value for key, value in before.items() if key != "made_at"})
    assert calibration_digest(tmp_path, "sim") == found.digest == recorded
    for bench in ("emulated", "hardware"):
        assert read_calibration(tmp_path, bench) is None and calibration_digest(tmp_path, bench) is None
        (told,) = not_counting(tmp_path, bench)
        assert "holds simulated results" in told.summary and f"bench `{bench}` accepts only" in told.summary
    assert not not_counting(tmp_path, "sim")
    write_calibration(tmp_path, "sim", replace(found, made_at="later"))
    assert (tmp_path / "calibration/sim.json").exists() and read_calibration(tmp_path, "sim").made_at == "later"


@pytest.mark.parametrize(
    ("bench", "evidence"), [("hardware", "emulated"), ("hardware", "simulated"), ("emulated", "simulated")]
)
def test_a_bench_refuses_what_was_found_elsewhere_and_names_both(tmp_path: Path, bench: str, evidence: str) -> None:
    own = {"hardware": "measured", "emulated": "emulated"}[bench]
    found = Calibration(stereo())
    steps = dict.fromkeys(results_of(found), provenance(evidence=own))
    write_calibration(tmp_path, bench, replace(found, provenance=steps))
    assert read_calibration(tmp_path, bench) is not None
    strange = {**steps, "extrinsics/left": provenance(bench="elsewhere", evidence=evidence)}
    write_calibration(tmp_path, bench, replace(found, provenance=strange))
    with pytest.raises(PicoError) as raised:
        read_calibration(tmp_path, bench)
    (wrong,) = raised.value.diagnostics
    assert (
        wrong.code == "calibration-evidence" and f"calibration/{bench}.json holds {evidence} results" in wrong.summary
    )
    assert "bench elsewhere: extrinsics/left" in wrong.summary and f"accepts only {own} ones" in wrong.summary
    assert f"{bench} calibrate" in wrong.hint
    write_calibration(tmp_path, bench, found)  # which says nothing of where it came from
    with pytest.raises(PicoError, match="holds simulated results"):
        read_calibration(tmp_path, bench)


def test_a_device_with_another_serial_number_is_named_with_both() -> None:
    found = Calibration(stereo(), provenance={"intrinsics/left": provenance(serials={"left": "A1", "right": "B1"})})
    assert other_devices(found, {"left": "A1", "right": "B1"}, "hardware") == []
    (wrong,) = other_devices(found, {"left": "A2"}, "hardware")
    assert wrong.code == "calibration-serial" and "left with serial number A1, and A2 answers" in wrong.summary
    assert "`pico --bench hardware calibrate intrinsics`" in wrong.hint


def test_axes_and_dark_levels_are_kept_with_how_they_were_found(tmp_path: Path) -> None:
    axes, dark = (
        {"p1.angle": AxisZero(direction=-1, zero=12.5, sigma=0.1)},
        {"cam.image": DarkLevel(level=1e-7, sigma=1e-9, noise=2e-9)},
    )
    made = Calibration(
        {},
        axes=axes,
        dark=dark,
        provenance={n: provenance(by="Ada", residual=0.2, unit="deg") for n in ("axes/p1.angle", "dark/cam.image")},
    )
    write_calibration(tmp_path, "hardware", made)
    again = read_calibration(tmp_path, "hardware")
    assert made_at(tmp_path, "hardware") == ""
    cameras = {f"extrinsics/{n}": provenance(at=f"2026-0{n}-01T00:00:00Z") for n in (5, 3, 7)}
    write_calibration(
        tmp_path, "emulated", replace(made, made_at="2026-11-01", provenance={**made.provenance, **cameras})
    )
    assert made_at(tmp_path, "emulated") == "2026-03-01T00:00:00Z", (
        "an axis that was calibrated since makes no camera newer"
    )
    assert again is not None and (again.axes, again.dark, again.provenance) == (axes, dark, made.provenance)
    assert made.digest != Calibration({}).digest
    plain = conversion(Wired(property="angle", scale=2.0, offset=5.0), "rad", "deg")
    right = axes["p1.angle"].corrects(plain)
    assert right.to_lab(0.1) == pytest.approx(12.5 - plain.to_lab(0.1))
    assert right.to_device(right.to_lab(0.1)) == pytest.approx(0.1)
    assert axes["p1.angle"].nominal(right.to_lab(0.1)) == pytest.approx(plain.to_lab(0.1))


def test_how_each_step_stands_says_why_it_does_not_count_and_how_old_it_is() -> None:
    known = {
        "intrinsics/left": provenance(serials={"left": "A1"}),
        "extrinsics/left": provenance(evidence="emulated", bench="emulated"),
    }
    subjects = {"intrinsics": ("left", "right"), "extrinsics": ("left",)}
    now = "2026-11-11T12:00:00Z"
    first, second, third = standing(subjects, known, "hardware", {"left": "A1"}, now, 20 * 86400.0)
    assert first.why == "" and first.age == pytest.approx(10.0) and second.why == "not done yet"
    assert third.why == "its result is emulated (bench emulated), and hardware accepts only measured ones"
    other, *_ = standing(subjects, known, "hardware", {"left": "A2"}, now, None)
    assert other.why == "it was made of left with serial number A1, and A2 answers"
    old, *_ = standing(subjects, known, "hardware", {}, now, 5 * 86400.0)
    assert old.why == "its result is 10.0 days old, and counts for 5"
