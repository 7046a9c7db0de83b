"""A mount that slipped: the axis reads as before, and light alone finds it elsewhere."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from bench_at import bench_at
from benches import sim

from pico.backends.sim.hand import power_cycle, slip
from pico.backends.sim.lighted import light_on
from pico.backends.sim.readings import Table
from pico.backends.sim.store import load_world, save_world, world_from_json
from pico.backends.sim.world import World, new_world, observe
from pico.diagnostics import PicoError
from pico.manifest.load import load_folder
from pico.model.observation import ObservedValue
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.resources import labs_dir


@pytest.fixture(scope="module")
def setup() -> Setup:
    """The bench of the case study."""
    return load_folder(labs_dir() / "shel").require()[0]


def crossed(setup: Setup, angle: float = 90.0) -> World:
    """The laser is on, and two polarizers stand in its beam, the second at `angle` from the first [deg]."""
    world = new_world(setup)
    for name, x, value in (("p1", 400.0, 0.0), ("p2", 700.0, angle)):
        world = world.with_body(name, pose=Pose(x, 420.0, 0.0))
        world = world.with_value(name, "angle", ObservedValue(value=value))
    for name, value in (("emission", True), ("shutter", "open")):
        world = world.with_value("laser", name, ObservedValue(value=value))
    return world


def power(setup: Setup, world: World) -> float:
    """Return what comes to the camera [mW]."""
    return sum(arrival.power for arrival in light_on(Table(setup, Path(), world)).at("cam"))


def test_light_alone_finds_what_slipped(setup: Setup) -> None:
    world = crossed(setup)
    slipped = slip(setup, slip(setup, world, "p2", "angle", -2.0), "p2", "angle", -1.0)
    assert power(setup, slipped) == pytest.approx(power(setup, crossed(setup, 87.0)), rel=1e-6)
    assert power(setup, slipped) > 50 * power(setup, world)
    assert observe(slipped, "sim", "") == observe(world, "sim", "")


def test_neither_homing_nor_a_power_cycle_brings_it_back_but_a_reset_does(setup: Setup, tmp_path: Path) -> None:
    table = sim(setup, tmp_path).world
    table.slip("p1", "angle", -0.5)
    table.power_cycle()
    world = load_world(setup, bench_at(tmp_path))[0]
    assert world.components["p1"].offsets == {"angle": -0.5}
    homed = world.with_value("p1", "angle", ObservedValue(value=0.0))
    assert homed.components["p1"].true_values["angle"] == -0.5
    assert power_cycle(setup, homed).components["p1"].true_values["angle"] == -0.5
    table.reset()
    assert load_world(setup, bench_at(tmp_path))[0].components["p1"].offsets == {}


def test_a_world_stored_before_mounts_slipped_is_read(setup: Setup, tmp_path: Path) -> None:
    save_world(bench_at(tmp_path), new_world(setup))
    data = json.loads((tmp_path / ".pico/benches/sim/world.json").read_text())
    for body in data["components"].values():
        body.pop("offsets", None)
    assert world_from_json(data) == new_world(setup)


@pytest.mark.parametrize(
    ("name", "tunable", "said"),
    [
        ("p11", "angle", "no component `p11`"),
        ("p1", "angel", "no tunable `angel`"),
        ("cam", "exposure", "no place of an axis"),
    ],
)
def test_what_cannot_slip_is_refused(setup: Setup, tmp_path: Path, name: str, tunable: str, said: str) -> None:
    with pytest.raises(PicoError, match=said):
        sim(setup, tmp_path).world.slip(name, tunable, 1.0)
