"""A lens that was calibrated elsewhere is read as it was written, and projects as OpenCV does, or is refused."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from pico.cameras.lens_files import read_lens
from pico.diagnostics import PicoError
from pico.manifest.load import load_folder
from pico.vision.calibration import camera_as_json, camera_from_json
from pico.vision.camera import CameraModel
from pico.vision.datums import SeenDatums
from pico.vision.lens import place_of
from pico.vision.rigid import apart, motion, rotation

SHEL = Path(__file__).resolve().parents[2] / "labs" / "shel"
MATRIX = [[1201.5, 0.0, 645.25], [0.0, 1199.0, 470.5], [0.0, 0.0, 1.0]]
FIVE, EIGHT = [-0.11, 0.05, 3e-4, -2e-4, 0.01], [0.4, -0.1, 3e-4, -2e-4, 0.01, 0.5, -0.08, 0.005]
FISHEYE = [-0.02, 0.01, -0.004, 0.001]
LEFT = CameraModel(
    "left", (1280, 960), np.array([[1200.0, 0, 639.5], [0, 1200.0, 479.5], [0, 0, 1]]), np.zeros(5),
    motion(rotation(np.array([np.pi, 0.0, 0.0])), np.array([500.0, 350.0, 1000.0])),
)  # fmt: skip
POINTS = np.array([(x, y, 0.0) for x in (150.0, 400.0, 620.0, 850.0) for y in (60.0, 300.0, 640.0)])


def ros(distortion: list[float], model: str = "plumb_bob", width: int = 1280) -> str:
    flat = [number for row in MATRIX for number in row]
    return (f"image_width: {width}\nimage_height: 960\ncamera_name: left\n"
            f"camera_matrix: {{rows: 3, cols: 3, data: {flat}}}\ndistortion_model: {model}\n"
            f"distortion_coefficients: {{rows: 1, cols: {len(distortion)}, data: {distortion}}}\n")  # fmt: skip


def opencv(path: Path, distortion: list[float]) -> None:
    """Have OpenCV itself write a file."""
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", 1280)
    storage.write("image_height", 960)
    storage.write("camera_matrix", np.array(MATRIX))
    storage.write("distortion_coefficients", np.array([distortion]))
    storage.release()


@pytest.mark.parametrize("name", ["lens.yaml", "lens.json"])
@pytest.mark.parametrize("distortion", [FIVE, EIGHT, FIVE[:4]])
def test_what_opencv_wrote_is_read(tmp_path: Path, name: str, distortion: list[float]) -> None:
    opencv(tmp_path / name, distortion)
    found = read_lens(tmp_path / name, LEFT)
    assert np.allclose(found.matrix, MATRIX) and len(found.distortion) in (5, 8)
    assert np.allclose(found.distortion[: len(distortion)], distortion) and not found.fisheye


@pytest.mark.parametrize(
    ("text", "distortion", "fisheye"),
    [
        (ros(FIVE), FIVE, False),
        (ros(EIGHT, "rational_polynomial"), EIGHT, False),
        (ros(FISHEYE, "equidistant"), FISHEYE, True),
        (json.dumps({"K": [n for row in MATRIX for n in row], "D": FIVE, "width": 1280, "height": 960}), FIVE, False),
        (json.dumps({"mtx": MATRIX, "dist": [EIGHT]}), EIGHT, False),
    ],
)
def test_a_lens_of_any_model_projects_as_opencv_does_and_is_kept(
    tmp_path: Path, text: str, distortion: list[float], fisheye: bool
) -> None:
    (tmp_path / "lens").write_text(text)
    found = read_lens(tmp_path / "lens", LEFT)
    assert found.fisheye == fisheye
    local = ((POINTS - LEFT.pose[:3, 3]) @ LEFT.pose[:3, :3]).reshape(-1, 1, 3)
    project = cv2.fisheye.projectPoints if fisheye else cv2.projectPoints
    seen, _ = project(local, np.zeros(3), np.zeros(3), np.array(MATRIX), np.array(distortion))
    assert np.allclose(found.project(POINTS), seen.reshape(-1, 2))
    origin, ways = found.rays(found.project(POINTS))
    assert np.allclose(origin + ways * (-origin[2] / ways[:, 2])[:, None], POINTS, atol=0.05)
    again = camera_from_json("left", json.loads(json.dumps(camera_as_json(found))))
    assert np.allclose(again.project(POINTS), found.project(POINTS), atol=1e-3) and again.fisheye == fisheye
    moved = replace(
        found, pose=motion(rotation(np.array([0.01, -0.01, 0.02])) @ found.pose[:3, :3], found.pose[:3, 3] + 3.0)
    )
    sigmas = np.array([0.5, 0.5, 0.5, 0.5, *(1e-4,) * len(found.distortion)])
    datums = SeenDatums(POINTS, found.project(POINTS), np.tile(np.eye(8) / 0.05, (len(POINTS) // 4, 1, 1)))
    placed = place_of(load_folder(SHEL).require()[0], datums, moved, sigmas)
    assert apart(placed.camera.pose, found.pose)[0] < 0.5 and placed.residual < 0.01


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (ros(FIVE, width=640), "it is of pictures of 640 x 960 pixels, and the lab has 1280 x 960"),
        (ros(FIVE[:3]), "its distortion has 3 coefficients; known: 4, 5, 8, and 4 of a fisheye lens"),
        (ros(FIVE, "equidistant"), "a fisheye lens has 4 coefficients, and it has 5"),
        (ros(FIVE, "thin_prism"), "its distortion model is `thin_prism`"),
        (ros(FIVE).replace("camera_matrix", "matrix"), "it has no `camera_matrix`"),
        (ros(FIVE).replace("1201.5", ".nan"), "a matrix holds something else than numbers"),
        (ros(FIVE).replace("1201.5", "-1201.5"), "none of a camera without skew"),
        ("[1, 2", "it is no YAML"),
        ("{", "Expecting property name"),
        ("- a\n", "it is no mapping"),
        ("a: &a [1]\nK: [*a, *a]\n", "it has aliases"),
    ],
)
def test_a_file_that_is_no_lens_of_the_camera_is_refused_by_its_cause(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "lens").write_text(text)
    with pytest.raises(PicoError) as raised:
        read_lens(tmp_path / "lens", LEFT)
    (wrong,) = raised.value.diagnostics
    assert wrong.code == "lens-file" and "describes no lens of camera `left`" in wrong.summary
    assert said in wrong.summary, wrong.summary


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(PicoError, match="No such file"):
        read_lens(tmp_path / "lens", LEFT)
