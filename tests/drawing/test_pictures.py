"""Pictures show what stands where, need no OpenGL and are the same on every run."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from physical import LABS, bench

from pico.bench.bench import Bench
from pico.drawing.camera_marks import mark_cameras
from pico.drawing.picture import placed, posed_model, render, scene_extent, write_png
from pico.drawing.standpoint import standpoint
from pico.drawing.topview import new_canvas
from pico.history.examples.example import make_example
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import home_state, place_of

W, H = 320, 240


@pytest.fixture(scope="module")
def setup() -> Setup:
    return bench()


@pytest.fixture(scope="module")
def poses(setup: Setup) -> dict[str, Pose]:
    return {name: place_of(setup, home_state(setup), name)[1] for name in setup.lab.inventory}


def near(image: np.ndarray, u: float, v: float, half: int = 2) -> np.ndarray:
    return image[round(v) - half : round(v) + half + 1, round(u) - half : round(u) + half + 1].reshape(-1, 3)


@pytest.mark.parametrize("view", ["perspective", "top"])
@pytest.mark.parametrize("size", [(320, 240), (301, 177)])
def test_size_and_type(setup: Setup, poses: dict[str, Pose], view: str, size: tuple[int, int]) -> None:
    image = render(setup, poses, {}, view=view, width=size[0], height=size[1])
    assert image.shape == (size[1], size[0], 3)
    assert image.dtype == np.uint8
    assert image.std() > 5


def test_the_red_camera_is_seen_where_it_stands(setup: Setup, poses: dict[str, Pose]) -> None:
    for x in (1060.0, 800.0):
        at = {**poses, "cam": Pose(x, 420.0, 0.0)}
        image = render(setup, at, {}, width=W, height=H, labels=False, beams=False)
        model, data = posed_model(setup, placed(at), {})
        view = standpoint(model, data, at, scene_extent(setup, model, data), W, H)
        u, v, _ = view.project(np.array([[x / 1000 + 0.008, 0.40, 0.07]]))[0]
        r, g, b = near(image, u, v).mean(axis=0)
        assert r > 1.5 * g
        assert r > 1.5 * b


def test_a_ring_shows_what_a_camera_hangs_over_unless_something_stands_there(
    setup: Setup, poses: dict[str, Pose]
) -> None:
    x, y, _ = setup.lab.cameras["left"].position
    drawn = []
    for at in (poses, {**poses, "cam": Pose(x, y - 20, 0.0)}):
        model, data = posed_model(setup, placed(at), {})
        view = standpoint(model, data, at, scene_extent(setup, model, data), 960, 720)
        image = np.full((720, 960, 3), 255, np.uint8)
        mark_cameras(image, view, setup, model, data)
        u, v, _ = view.project(np.array([[x / 1000, y / 1000, 0.0]]))[0]
        drawn.append((near(image, u, v, 20) < 200).sum())
    assert drawn[0] > 200 and drawn[1] < 0.5 * drawn[0]


def test_a_component_that_is_gone_is_not_drawn(setup: Setup, poses: dict[str, Pose]) -> None:
    without = {name: pose for name, pose in poses.items() if name != "cam"}
    image = render(setup, without, {}, width=W, height=H, labels=False, beams=False).astype(int)
    red = (image[:, :, 0] > image[:, :, 1] + 60) & (image[:, :, 0] > image[:, :, 2] + 60)
    shown = render(setup, poses, {}, width=W, height=H, labels=False, beams=False).astype(int)
    there = (shown[:, :, 0] > shown[:, :, 1] + 60) & (shown[:, :, 0] > shown[:, :, 2] + 60)
    assert there.sum() > red.sum() + 20


def test_the_beam_is_red_up_to_the_camera_and_not_beyond(setup: Setup, poses: dict[str, Pose]) -> None:
    at = {name: poses[name] for name in ("laser", "cam")}
    canvas = new_canvas(setup, 960, 720)
    image = render(setup, at, {}, view="top", width=960, height=720, labels=False)
    u, v = canvas.pixel((640.0, 420.0))
    assert near(image, u, v, 1)[:, 0].max() > near(image, u, v, 1)[:, 2].min() + 100
    u, v = canvas.pixel((1160.0, 420.0))
    assert (near(image, u, v, 3).max(axis=1) - near(image, u, v, 3).min(axis=1)).max() < 30


def test_ghosts_stand_where_parts_are_to_go(setup: Setup, poses: dict[str, Pose]) -> None:
    goal = Pose(800.0, 250.0, 0.0)
    canvas = new_canvas(setup, 960, 720)
    plain = render(setup, poses, {}, view="top", width=960, height=720)
    drawn = render(setup, poses, {}, view="top", width=960, height=720, ghosts={"p2": goal})
    changed = np.abs(plain.astype(int) - drawn).sum(axis=2) > 60
    u, v = canvas.pixel((800.0 - 30.0, 250.0))
    assert changed[round(v) - 15 : round(v) + 16, round(u) - 2 : round(u) + 3].any()
    u, v = canvas.pixel((1000.0, 700.0))
    assert not changed[: round(v)].any()


def test_the_arm_is_drawn_with_its_joints(setup: Setup, poses: dict[str, Pose]) -> None:
    turned = {"arm1": (1.0, -0.7, 0.0, 0.6, 0.0, 1.3, 0.0)}
    for view in ("perspective", "top"):
        parked = render(setup, poses, {}, view=view, width=W, height=H)
        assert (render(setup, poses, turned, view=view, width=W, height=H) != parked).mean() > 0.01


@pytest.mark.parametrize("view", ["perspective", "top"])
def test_same_input_same_bytes(setup: Setup, poses: dict[str, Pose], view: str, tmp_path: Path) -> None:
    files = [tmp_path / "a.png", tmp_path / "b.png"]
    for file in files:
        write_png(render(setup, poses, {}, view=view, width=W, height=H), file)
    assert files[0].read_bytes() == files[1].read_bytes()
    read = cv2.imread(str(files[0]))
    assert (read[:, :, ::-1] == render(setup, poses, {}, view=view, width=W, height=H)).all()


def test_an_empty_table_and_strange_names_are_drawn(setup: Setup) -> None:
    assert render(setup, {}, {}, width=W, height=H).shape == (H, W, 3)
    far = replace(setup, lab=replace(setup.lab, robots={}))
    assert render(far, {}, {}, view="top", width=W, height=H).shape == (H, W, 3)


def test_pictures_need_no_opengl() -> None:
    code = f"""
import sys
sys.modules["OpenGL"] = sys.modules["glfw"] = None  # as where they are not installed
sys.path.insert(0, {str(LABS.parent)!r})
from pathlib import Path
from pico.manifest.load import load_folder
from pico.drawing.picture import render
setup, _ = load_folder(Path({str(LABS / "minimal")!r})).require()
assert render(setup, {{}}, {{}}, width=64, height=48).std() > 1
maps = Path("/proc/self/maps")
loaded = maps.read_text() if maps.exists() else ""
assert not any(library in loaded for library in ("libEGL", "libGL.", "libGLX", "libOSMesa"))
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_laser_that_is_off_throws_no_beam(tmp_path: Path) -> None:
    make_example("minimal", tmp_path / "lab")
    with Bench.open(tmp_path / "lab") as bench:
        laser = next(n for n in bench.setup.lab.inventory if bench.setup.type_of(n).optics.element == "source")
        shown = [bench.pictures.render(view="top", size=(W, H)).astype(int)]
        bench.apply()
        shown.append(bench.pictures.render(view="top", size=(W, H)).astype(int))
    red = [((image[:, :, 0] - image[:, :, 2] > 90) & (image[:, :, 1] < 110)).sum() for image in shown]
    assert bench.state.components[laser].values["emission"] is True and red[0] < red[1]
