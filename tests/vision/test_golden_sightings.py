"""What is said of corners that are given as numbers, kept as text: see `kept`. No picture is drawn."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from painted import Painted, bumped, looking, plate_of, scattered, scene, setup, stereo

sys.path.append(str(Path(__file__).resolve().parent.parent))

from kept import differs

from pico.model.lab import Camera
from pico.model.pose import Pose
from pico.vision.anchor import anchored
from pico.vision.calibration import Accuracy, Calibration
from pico.vision.camera import CameraModel
from pico.vision.localize import recognize
from pico.vision.markers import Fragment, Markers, read_marker
from pico.vision.rigid import moved, square, upright
from pico.vision.sighting import Sighting

BENCH = setup(5)
EYE = Camera(position=(0, 60, -60), look_at=(0, 60, 100), robot="arm1")
HAND = replace(BENCH, lab=replace(BENCH.lab, cameras={**BENCH.lab.cameras, "eye": EYE}))
CAMERAS = {**stereo(), "eye": looking("eye", (500, 250, 420), (500, 350, 140))}
POSES = scattered(BENCH, np.random.default_rng(11))
ALL = scene(BENCH, POSES)
FINE = Calibration(CAMERAS)


def seen_by(camera: CameraModel, plates: list[Painted], seed: int = 0, noise: float = 0.05) -> Markers:
    """Return the corners that a camera sees, each off by some noise."""
    rng, found = np.random.default_rng(seed), []
    for plate in plates:
        corners = camera.project(square(plate.size) @ plate.pose[:3, :3].T + plate.pose[:3, 3])
        found.append(read_marker(plate.number, corners + rng.normal(0, noise, (4, 2)), camera.name, max(noise, 0.01)))
    return Markers(camera.name, tuple(found))


def both(plates: list[Painted], names: tuple[str, ...] = ("left", "right")) -> list[Markers]:
    return [seen_by(CAMERAS[name], plates, n) for n, name in enumerate(names)]


def changed(number: int, *change: float, size: float = 24.0) -> list[Painted]:
    """The bench with one plate shifted [mm] and turned [deg] in space."""
    by = np.array([*change[:3], *(math.radians(v) for v in change[3:])])
    return [replace(p, pose=moved(p.pose, by), size=size) if p.number == number else p for p in ALL]


def scenes() -> Iterator[tuple[str, Sighting]]:
    extra = replace(plate_of(BENCH, "part_1", Pose(480, 340, 12)), number=77)
    copy = replace(plate_of(BENCH, "part_2", Pose(520, 360, 40)), number=2)
    yield "all", recognize(BENCH, both(ALL), FINE)
    yield "one camera", recognize(BENCH, both(ALL, ("left",)), FINE)
    rough = Accuracy(position=0.5, yaw=0.3, height=1.0, pixels=1.0, upright=1.0)
    yield "badly calibrated", recognize(BENCH, both(ALL), Calibration(CAMERAS, rough))
    yield "held", recognize(BENCH, both(ALL), FINE, held=("part_3",))
    yield "hidden", recognize(BENCH, both([p for p in ALL if p.number not in (3, 4)]), FINE, held=("part_4",))
    yield "a stranger", recognize(BENCH, both([*ALL, extra]), FINE)
    yield "a stranger in one picture", recognize(BENCH, both([*ALL, extra], ("left",)), FINE)
    yield "one twice", recognize(BENCH, both([*ALL, copy]), FINE)
    yield "a stranger twice", recognize(BENCH, both([*ALL, extra, replace(extra, pose=copy.pose)]), FINE)
    left, right = both(ALL)
    away = seen_by(CAMERAS["right"], [*(p for p in ALL if p.number != 2), copy], 1)
    yield "at two places in two pictures", recognize(BENCH, [left, away], FINE)
    stray = [
        seen_by(CAMERAS["right"], [*ALL, replace(extra, pose=moved(extra.pose, np.array([-250.0, 90, 0, 0, 0, 0])))])
    ]
    yield "a stranger at two places", recognize(BENCH, [both([*ALL, extra])[0], *stray], FINE)
    for name, change in {
        "leaning": (0, 0, 0, 20, 0, 0), "leaning a bit": (0, 0, 0, 2.5, 0, 0), "leaning over": (0, 0, 0, 0, -50, 0),
        "low": (0, 0, -10, 0, 0, 0), "a bit low": (0, 0, -1.5, 0, 0, 0), "high": (0, 0, 25, 0, 0, 0),
    }.items():  # fmt: skip
        for names in (("left", "right"), ("left",)):
            yield f"{name}, by {len(names)}", recognize(BENCH, both(changed(4, *change), names), FINE)
    for size in (22.8, 23.6, 30.0):
        yield f"of {size} mm", recognize(BENCH, both(changed(4, 0, 0, 0, 0, 0, 0, size=size)), FINE)
    for shift in (0.3, 2.0, 20.0):
        true = bumped(CAMERAS["right"], (shift, shift, shift / 2), (0.0, 0.0, shift / 20))
        yield f"bumped by {shift}", recognize(BENCH, [left, replace(seen_by(true, ALL), camera="right")], FINE)
        yield f"a datum off by {shift}", recognize(BENCH, both(changed(991, shift, 0, 0, 0, 0, 0)), FINE)
    two = [replace(p, pose=moved(p.pose, np.array([4.0, 3, 0, 0, 0, 0]))) if p.number in (991, 993) else p for p in ALL]
    yield "two datums off", recognize(BENCH, both(two), FINE)
    yield "two datums seen", recognize(BENCH, both([p for p in ALL if p.number not in (991, 993)]), FINE)
    bare = replace(BENCH, lab=replace(BENCH.lab, datums={}))
    yield "no datums", recognize(bare, both([p for p in ALL if p.number < 900]), FINE)
    close = [p for p in ALL if p.number < 900 and np.hypot(*(p.pose[:2, 3] - (500, 350))) < 250]
    yield "by the eye alone", recognize(HAND, both(close, ("eye",)), FINE)
    yield "by the eye besides", recognize(HAND, [*both(ALL), *both(close, ("eye",))], FINE)
    spots = [
        upright(Pose(x, y, 10), 140.0) for x, y in ((480, 340), (481, 340), (POSES["part_1"].x, POSES["part_1"].y))
    ]
    squares = [CAMERAS["left"].project(square(s) @ p[:3, :3].T + p[:3, 3]) for p in spots for s in (24.0, 60.0, 12.0)]
    torn = replace(left, fragments=tuple(Fragment(corners, "left") for corners in squares))
    yield "torn", recognize(BENCH, [torn, right], FINE)


def told(found: Sighting) -> Iterator[str]:
    for name, part in found.components.items():
        pose, sigma = part.pose, part.uncertainty
        yield f"  {name} {pose.x:.3f} {pose.y:.3f} {pose.yaw:.3f} within {sigma.position:.3g} {sigma.yaw:.3g}"
        yield f"    {part.height:.2f} high, by {', '.join(part.cameras)}: {part.how}"
    for name, thing in found.unknown.items():
        pose, sigma = thing.pose, thing.uncertainty
        yield f"  {name} {pose.x:.2f} {pose.y:.2f} {pose.yaw:.2f} within {sigma.position:.3g} {sigma.yaw:.3g}"
        yield f"    {thing.marker}: {thing.height:.2f} high, {thing.size:.2f} large"
    yield f"  checked {', '.join(found.checked)}; toppled {', '.join(found.toppled)}; trusted {found.trusted}"
    for finding, said in zip(found.findings, found.diagnostics()[len(found.drift) :], strict=True):
        yield f"  {said.severity} {said.code} {said.address} {finding.marker} {finding.at}: {said.summary}"
        yield f"    {said.hint}"
    yield from (f"  {said.severity} {said.summary}" for said in found.diagnostics()[: len(found.drift)])


def test_what_is_seen_is_what_was_seen() -> None:
    lines = [line for name, found in scenes() for line in (name, *told(found))]
    assert not differs("sightings.txt", "\n".join(lines) + "\n")


def test_cameras_are_put_right_as_they_were() -> None:
    lines = []
    for n, (shift, turn) in enumerate([((0.3, -0.2, 0.1), (0.0, 0.0, 0.05)), ((1.0, 0.5, -0.5), (0.05, -0.05, 0.0))]):
        true = bumped(CAMERAS["left"], shift, turn)
        right = anchored(BENCH, CAMERAS["left"], seen_by(true, ALL, n))
        numbers = (*right.pose[:3, 3], *right.pose[:3, :3].ravel(), *np.diag(right.matrix))
        lines.append(" ".join(f"{v:.4f}" for v in numbers))
    assert not differs("anchored.txt", "\n".join(lines) + "\n")


def test_an_eye_is_where_its_hand_is() -> None:
    tool = upright(Pose(400, 300, 30), 250.0)
    riding = replace(CAMERAS["eye"], robot="arm1")
    placed = Calibration({"eye": riding, "left": CAMERAS["left"]}).placed({"arm1": tool})
    assert np.allclose(placed.cameras["eye"].pose, tool @ riding.pose) and placed.cameras["eye"].robot is None
    assert placed.cameras["left"] is CAMERAS["left"]
    assert Calibration({"eye": riding}).placed({}).cameras["eye"] is riding
