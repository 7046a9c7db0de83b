"""Cameras that somebody bumped: the simulated world remembers it, and its pictures show it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench_at import bench_at
from benches import sim

from pico.backends.sim.cameras import bump, eyes_of
from pico.backends.sim.reconcile import reconcile
from pico.backends.sim.store import load_world, save_world, world_from_json
from pico.backends.sim.world import new_world
from pico.cameras.errors import CameraShift
from pico.diagnostics import PicoError
from pico.drawing.picture import posed_model
from pico.manifest.load import load_folder
from pico.model.setup import Setup
from pico.resources import labs_dir
from pico.vision.nominal import camera_models

BY = CameraShift(shift=(3.0, 0.0, -1.0), turn=(0.0, 0.0, 0.5))


@pytest.fixture(scope="module")
def setup() -> Setup:
    """The bench of the case study."""
    return load_folder(labs_dir() / "shel").require()[0]


def test_a_bump_stays_until_a_reset(setup: Setup, tmp_path: Path) -> None:
    table = sim(setup, tmp_path).world
    table.bump("left", shift=(3.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0))
    table.bump("left", shift=(0.0, 0.0, -1.0), turn=(0.0, 0.0, 0.5))
    assert load_world(setup, bench_at(tmp_path))[0].cameras == {"left": BY}
    table.reset()
    assert load_world(setup, bench_at(tmp_path))[0].cameras == {}


def test_a_world_stored_before_cameras_had_bumps_is_read(setup: Setup, tmp_path: Path) -> None:
    save_world(bench_at(tmp_path), new_world(setup))
    data = json.loads((tmp_path / ".pico/benches/sim/world.json").read_text())
    del data["cameras"]
    assert world_from_json(data) == new_world(setup)


def test_a_camera_that_the_lab_lost_is_forgotten(setup: Setup) -> None:
    world = bump(setup, new_world(setup), "left", BY)
    fewer = {name: camera for name, camera in setup.lab.cameras.items() if name != "left"}
    without = replace(setup, lab=replace(setup.lab, cameras=fewer))
    assert reconcile(without, world)[0].cameras == {}


def test_the_pictures_come_from_where_the_camera_was_bumped_to(setup: Setup) -> None:
    world = bump(setup, new_world(setup), "left", BY)
    eyes = eyes_of(setup, world, *posed_model(setup, {}, {}))
    before = camera_models(setup)
    assert eyes.placed("left").pose[:3, 3] - before["left"].pose[:3, 3] == pytest.approx(BY.shift)
    assert np.array_equal(eyes.placed("right").pose, before["right"].pose)


def test_without_a_name_all_cameras_at_the_table_move_as_one(setup: Setup) -> None:
    world = bump(setup, new_world(setup), None, BY)
    assert world.cameras.keys() == {"left", "right"}
    eyes, before = eyes_of(setup, world, *posed_model(setup, {}, {})), camera_models(setup)
    apart = [np.linalg.inv(cameras["left"].pose) @ cameras["right"].pose for cameras in (eyes.cameras, before)]
    assert apart[0] == pytest.approx(apart[1], abs=1e-9)
    assert np.linalg.norm(eyes.cameras["left"].pose[:3, 3] - before["left"].pose[:3, 3]) > 3


def test_an_unknown_camera_can_not_be_bumped(setup: Setup) -> None:
    with pytest.raises(PicoError, match="no camera `lefty`") as raised:
        bump(setup, new_world(setup), "lefty", BY)
    assert raised.value.diagnostics[0].hint == "did you mean `left`?"
