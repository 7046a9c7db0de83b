"""The numbers that fits come to, with how sure they are and what is left, kept as text: see `kept`. Pictures are small
and many; how they are taken, and what is wrong with them, follows from seeds."""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from painted import Painted, bumped, looking, picture, setup, stereo
from test_calibration import glances, poses, seen, table
from test_golden_sightings import seen_by

sys.path.append(str(Path(__file__).resolve().parent.parent))

from kept import differs

from pico.diagnostics import PicoError
from pico.model.catalog import MarkerPlate
from pico.model.lab import Datum
from pico.model.pose import Pose
from pico.vision.anchor import anchored
from pico.vision.bundle import bundle
from pico.vision.calibration import Accuracy, Calibration
from pico.vision.camera import CameraModel
from pico.vision.charuco import BOARD, board_image, find_board
from pico.vision.datums import check, datum_corners, resection
from pico.vision.frame import Frame
from pico.vision.hand_eye import hand_eye
from pico.vision.judge import judged
from pico.vision.least_squares import solve
from pico.vision.lens import lens
from pico.vision.markers import Markers, cells, clear, detect
from pico.vision.poses import MarkerView, free, from_rays, on_plane
from pico.vision.refine import refine
from pico.vision.rigid import motion, moved, rotation, square, upright

BENCH = setup(2)
WITHIN = 1e-4
"""The share by which numbers may differ."""
LENS = (-0.15, 0.04, 0.001, -0.0005, 0.01)


def numbers(values: object, digits: int = 5) -> str:
    return " ".join(f"{v:.{digits}g}" for v in np.ravel(np.asarray(values, np.float64)) + 0.0)


def close_up(rng: random.Random, count: int) -> tuple[CameraModel, list[Painted]]:
    """A small camera, and plates of many sizes and tilts before it; some are cut by the picture's edge or covered."""
    camera = looking("near", (0, -40, 300), (0, 0, 0), (320, 240), 45, rng.choice((None, LENS)))
    plates = []
    for number in range(count):
        x, y = -90 + 180 / count * (number + 0.5) + rng.uniform(-5, 5), rng.uniform(-75, 75)
        lean = np.array([0, 0, 0, *(rng.choice((0.0, 0.1, 0.5)) * rng.uniform(-1, 1) for _ in range(2)), 0])
        pose = moved(upright(Pose(x, y, rng.uniform(-180, 180)), rng.uniform(-20, 40)), lean)
        covered = rng.choice((-1e9, -1e9, -1e9, -9.0, -5.0, 2.0))
        plates.append(Painted(rng.randrange(1000), pose, rng.choice((9.0, 14.0, 20.0, 26.0)), covered))
    return camera, plates


def shown(rng: random.Random, camera: CameraModel, plates: list[Painted]) -> Frame:
    """What is seen of plates: more or less sharp, noisy, and rich in contrast, and in a part of the sensor."""
    painted = picture(
        camera, plates, np.random.default_rng(rng.randrange(1000)), rng.choice((0.0, 2.0, 6.0)),
        rng.choice((0.0, 0.7, 1.4)),
    )  # fmt: skip
    share = rng.choice((1.0, 1.0, 0.5, 0.2, 0.12))
    gray = np.clip(np.round(120 + (painted.gray.astype(float) - 120) * share), 0, 255).astype(np.uint8)
    return Frame(gray, (rng.choice((0, 40)), rng.choice((0, 25))), camera.name, 0.0)


@pytest.mark.parametrize("first", range(0, 32, 8))
def test_markers_of_small_pictures_are_found_as_they_were(first: int) -> None:
    lines = []
    for seed in range(first, first + 8):
        rng = random.Random(seed)
        camera, plates = close_up(rng, 5)
        found = detect(shown(rng, camera, plates))
        lines.append(f"seed {seed}: twice {sorted(found.duplicates)}")
        for m in sorted(found.markers, key=lambda m: m.number):
            spread = np.diag(m.covariance)
            lines.append(f"  {m.number}: {numbers(m.corners, 7)} noise {numbers(m.noise, 4)} of {numbers(spread, 4)}")
        lines += [f"  fragment {numbers(f.corners, 4)}" for f in found.fragments]
    assert not differs(f"small_pictures_{first:02}.txt", "\n".join(lines) + "\n", WITHIN)


def test_markers_are_fitted_as_they_were() -> None:
    """From corners that are off, in pictures of many sizes; small ones, and such that show no marker."""
    lines = []
    for seed in range(14):
        rng = random.Random(seed)
        side = (6, 11, 16, 24, 16, 11, 120)[seed % 7 if seed < 7 else seed % 6]
        camera = looking("near", (0, -30, 6 * 240 * 24 / 5 / side), (0, 0, 0), (2 * side + 20, 2 * side + 16), 10)
        plate = Painted(rng.randrange(1000), upright(Pose(*(rng.uniform(-2, 2) for _ in range(2)), 20 * seed), 0.0))
        corners = camera.project(square(24.0) @ plate.pose[:3, :3].T + plate.pose[:3, 3])
        frame = picture(
            camera, [plate], np.random.default_rng(seed), rng.choice((0.5, 3.0)), rng.choice((0.0, 0.7, 2.0))
        )
        gray = frame.gray if seed != 9 else np.full_like(frame.gray, 77)
        off = np.array([[rng.uniform(-1, 1) for _ in range(2)] for _ in range(4)]) * rng.choice((0.3, 1.0, side / 10))
        fit = refine(gray, corners + off, cells(plate.number), rng.choice((0.8, 0.5)))
        whole = clear(gray, corners, plate.number), clear(gray, corners, plate.number + 1)
        lines.append(f"{seed}: {np.abs(np.diff(corners, axis=0)).max():.0f} pixels, clear {whole}")
        if fit:
            lines.append(f"  {numbers(fit.corners - corners, 4)}, misfit {fit.misfit:.5f}, blur {fit.blur:.4f}")
            lines.append(f"  {numbers(fit.covariance[:3], 4)}")
    assert not differs("fitted_markers.txt", "\n".join(lines) + "\n", WITHIN)


def test_boards_are_found_as_they_were() -> None:
    lines, rng = [], np.random.default_rng(9)
    for scale in (0.6, 1.2, 2.0):
        print_ = np.pad(board_image(BOARD, scale), 30, constant_values=255)
        noisy = print_ * 0.7 + 30 + rng.normal(0, 6, print_.shape)
        print_ = np.clip(np.round(noisy), 0, 255).astype(np.uint8)
        for part in (1.0, 0.8, 0.66):
            gray = np.ascontiguousarray(print_[: round(part * len(print_))])
            found = find_board(Frame(gray, (7, 3), "left", 0.0))
            lines.append(f"{scale} {part}: " + (f"{len(found.corners)} corners" if found else "none"))
            if found:
                lines.append(f"  {numbers(found.corners[[0, -1]])}; {numbers(found.pixels[[0, 1, -1]], 5)}")
    assert not differs("boards.txt", "\n".join(lines) + "\n", WITHIN)


def described(name: str, camera: CameraModel) -> str:
    return (
        f"{name}: {numbers(lens(camera), 6)} at {numbers(camera.pose[:3, 3], 7)} turned {numbers(camera.pose[:3, :3])}"
    )


def test_cameras_are_calibrated_as_they_were() -> None:
    """Fixed cameras, with corners that are off, a camera that misses some boards; then an eye in the hand."""
    rng, lines = np.random.default_rng(6), []
    true = {n: bumped(c, rng.uniform(-3, 3, 3), rng.uniform(-0.5, 0.5, 3)) for n, c in stereo(distortion=LENS).items()}
    shots = [{n: seen(c, pose, rng) for n, c in true.items()} for pose in poses(rng, 7)]
    shots[2]["left"].pixels[3:6] += 1.5
    del shots[4]["right"], shots[5]["left"]
    found = bundle(BENCH, shots, {n: table(c, rng) for n, c in true.items()}, stereo())
    lines += [described(name, camera) for name, camera in found.cameras.items()]
    lines += [f"{numbers(list(found.residuals.values()))}, {found.position:.5f} mm"]
    for name, too_few in (("boards", shots[:5]), ("all", shots)):
        datums = {n: Markers(n, table(c, rng).markers[: 2 if name == "all" else 4]) for n, c in true.items()}
        with pytest.raises(PicoError) as refused:
            bundle(BENCH, too_few, datums, stereo())
        lines += [f"{name}: {d.summary} | {d.hint}" for d in refused.value.diagnostics]
    camera = replace(stereo()["left"], name="hand", robot="arm1")
    mount = motion(rotation(np.array([0.1, -0.2, 1.5])), np.array([60.0, 5, -40]))
    tools, board = glances(mount, np.random.default_rng(2), 6)
    eye = hand_eye([seen(replace(camera, pose=t @ mount), board, rng) for t in tools], tools, camera)
    lines += [
        described("eye", eye.camera),
        *(f"{k} {numbers(v)}" for k, v in sorted(vars(eye).items()) if k != "camera"),
    ]
    made = Calibration(found.cameras, residuals=found.residuals).as_json()
    lines.append(str(made["cameras"]["left"]))
    assert not differs("calibrated.txt", "\n".join(lines) + "\n", 10 * WITHIN)  # k3 is known to 0.02


def verdicts() -> Iterator[str]:
    """Markers that lean, stand off their height or have another size by about as much as is let pass."""
    cameras, plate = stereo(distortion=LENS), MarkerPlate(size=24.0, at=(0, 0, 140.0))
    for n, (kind, by) in enumerate([
        *(("lean", d) for d in (2.5, 2.9, 3.0, 3.3, 6.0)), *(("rise", z) for z in (-2.4, -1.9, 1.9, 2.1, 40.0, -195.0)),
        *(("grow", s) for s in (0.95, 0.968, 0.972, 1.028, 1.033, 1.2)), *(("slide", s) for s in (0.2, 0.5, 1.0, 3.0)),
    ]):  # fmt: skip
        change = np.array([0, 0, by * (kind == "rise"), math.radians(by) * (kind == "lean"), 0, 0])
        place = moved(upright(Pose(430 + 10 * n, 300, 15 * n), 140.0), change)
        size = 24.0 * (by if kind == "grow" else 1.0)
        other = moved(place, np.array([by * (kind == "slide"), 0, 0, 0, 0, 0]))
        for noise in ((0.01, 0.2)[n % 2],):
            views = [
                MarkerView(cameras[c], seen_by(cameras[c], [Painted(5, p, size)], n, noise).markers[0])
                for c, p in (("left", place), ("right", other))
            ]
            for accuracy in (Accuracy(), Accuracy(pixels=2.0, height=1.0))[n // 2 % 2 :][:1]:
                for given in (views, views[:1], views[1:]):
                    said = judged(given, plate, accuracy, in_hand=n % 2 > 0)
                    found = said.estimate
                    yield f"{kind} {by} {noise} {accuracy.pixels} {len(given)}: {said.how} {said.kind} {said.text}"
                    if found and accuracy.pixels == 2.0:
                        sure = found.uncertainty
                        yield f"  {numbers(found.pose[:3, 3], 7)} {numbers(found.pose[0, :3])} {found.residual:.4f}"
                        sigmas = (found.tilt_sigma, found.height_sigma, sure.position, sure.yaw)
                        yield f"  {numbers((found.tilt, *sigmas))}"
            start = moved(place, np.array([1.0, -1, 2, 0.02, 0, 0.03]))
            fits = from_rays(views, size), on_plane(views[:1], size, 140.0, 0.5, 0.3), free(views[0], size, start)
            for fit in fits if by in (2.5, 1.9, 0.972) else ():
                spread = numbers(np.sqrt(np.diag(fit.covariance)))
                yield f"  {numbers(fit.pose[:3], 6)}, left {fit.residual:.5f}, {spread}"


def test_markers_are_judged_as_they_were() -> None:
    assert not differs("judged_markers.txt", "\n".join(verdicts()) + "\n", WITHIN)


def test_what_datums_tell_is_what_they_told() -> None:
    """Cameras bumped, and datums shifted, by about as much as is let pass; three to five datums."""
    lines, camera = [], stereo()["left"]
    for seed in range(20):
        rng = random.Random(seed)
        datums = {
            f"d{k}": Datum(marker=900 + k, x=rng.uniform(50, 900), y=rng.uniform(50, 600)) for k in range(3 + seed % 3)
        }
        bench = replace(BENCH, lab=replace(BENCH.lab, datums=datums))
        shift = rng.choice((0.0, 0.3, 0.6, 4.0)) if seed % 2 else 0.0
        true, corners = bumped(camera, (shift, 0, shift)), {n: datum_corners(d) for n, d in datums.items()}
        for name in rng.sample(sorted(datums), rng.randint(0, 2)):
            corners[name] = corners[name] + (rng.choice((0.2, 0.45, 0.6, 3.0)), 0, 0)
        plates = [Painted(d.marker, motion(np.eye(3), corners[n].mean(axis=0)), d.size) for n, d in datums.items()]
        picture_ = seen_by(true, plates, seed, 0.03)
        said, loose = check(bench, picture_, camera, Accuracy(position=rng.choice((0.05, 0.2))))
        bump = f"moved {said.shift:.4f} {said.turn:.4f} {said.effect:.4f}" if said else "still"
        lines.append(f"{seed}: {bump}; {'; '.join(f.text for f in loose)}")
        lines.append(f"  {described('anchored', anchored(bench, camera, picture_))}")
        pixels = np.concatenate([m.corners for m in picture_.markers])
        where = resection(np.concatenate(list(corners.values())), pixels, camera)
        lines.append(f"  {numbers(where.pose[:3, 3], 6)} left {where.residual:.4f}")
    assert not differs("datums.txt", "\n".join(lines) + "\n", WITHIN)


def test_least_squares_end_where_they_ended() -> None:
    """A valley, a curve through points, one with a needless parameter, and one that can't be computed far away."""
    xs, lines = np.linspace(0, 1, 9), []
    ys = 2 * np.exp(-1.3 * xs) + 0.1 * np.sin(40 * xs)
    problems = {
        "valley": (lambda p: np.array([10 * (p[1] - p[0] ** 2), 1 - p[0]]), (-1.2, 1.0)),
        "curve": (lambda p: p[0] * np.exp(p[1] * xs) - ys, (1.0, 0.0)),
        "needless": (lambda p: (p[0] + p[1]) * xs - 2 * xs, (0.0, 0.0)),
        "cliff": (lambda p: np.array([np.log(p[0]) if p[0] > 0 else np.nan, p[1] - 1]), (8.0, 3.0)),
        "flat": (lambda p: np.array([1.0 + 0 * p[0], 2.0]), (1.0, 1.0)),
    }
    for name, (residuals, start) in problems.items():
        for rounds in (1, 3, 30):
            asked = [0]

            def counted(p, residuals=residuals, asked=asked):
                asked[0] += 1
                return residuals(p)

            found = solve(counted, np.array(start), np.array([1e-6, 1e-6]), rounds)
            said = f"{numbers(found.parameters, 6)}, {numbers(found.covariance, 4)}, left {found.rms:.4g}"
            lines.append(f"{name} {rounds}: {said}, {asked[0]} times")
    assert not differs("least_squares.txt", "\n".join(lines) + "\n", WITHIN)
