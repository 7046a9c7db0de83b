"""What befalls a part that no camera over the bench sees: it stands and reads as before, and light alone tells."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench_at import bench_at
from benches import sim
from hypothesis import given
from hypothesis import strategies as st

from pico.backends.sim.hand import clear, hidden, slip, upset
from pico.backends.sim.lighted import light_on
from pico.backends.sim.readings import Table, measurer_of
from pico.backends.sim.store import load_world, save_world
from pico.backends.sim.world import World, new_world, observe
from pico.diagnostics import PicoError
from pico.manifest.load import load_folder
from pico.model.observation import ObservedValue
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.optics.upsets import parse
from pico.resources import labs_dir


@pytest.fixture(scope="module")
def setup() -> Setup:
    """The bench of the case study."""
    return load_folder(labs_dir() / "shel").require()[0]


@pytest.fixture(scope="module")
def lit(setup: Setup) -> World:
    """A lens of 100 mm stands 200 mm before the camera, and the laser is on."""
    world = new_world(setup).with_body("lx_100", pose=Pose(800.0, 420.0, 0.0))
    for name, value in (("emission", True), ("shutter", "open")):
        world = world.with_value("laser", name, ObservedValue(value=value))
    return world


def arrival(setup: Setup, world: World) -> tuple[float, float, float]:
    """Return where on the camera the beam falls [mm], and with which power [mW]."""
    (found,) = light_on(Table(setup, Path(), world)).at("cam")
    return (*found.center, found.power)


@given(by=st.floats(-0.2, 0.2))
def test_a_lens_that_is_displaced_sends_the_beam_by_its_magnification(setup: Setup, lit: World, by: float) -> None:
    before, after = arrival(setup, lit), arrival(setup, upset(setup, lit, "lx_100", {"up": by}))
    aside = arrival(setup, upset(setup, lit, "lx_100", {"left": by}))
    far = 1060.0 - 800.0
    assert after[1] - before[1] == pytest.approx(by * far / 100.0, rel=0.02, abs=1e-6)
    assert aside[0] - before[0] == pytest.approx(after[1] - before[1], rel=1e-3, abs=1e-6)
    assert after[2] == pytest.approx(before[2], rel=1e-6)


@given(loss=st.floats(0.0, 0.9), again=st.floats(0.0, 0.9))
def test_dirt_stops_its_share_wherever_it_is(setup: Setup, lit: World, loss: float, again: float) -> None:
    before = arrival(setup, lit)[2]
    for name in ("laser", "hwp", "lx_100", "cam"):
        dirty = upset(setup, upset(setup, lit, name, {"loss": loss}), name, {"loss": again})
        assert arrival(setup, dirty)[2] == pytest.approx(before * (1 - loss) * (1 - again), rel=1e-9)


def test_a_camera_that_was_bumped_sees_the_beam_move_the_other_way(setup: Setup, lit: World) -> None:
    before, after = arrival(setup, lit), arrival(setup, upset(setup, lit, "cam", {"left": 0.05, "up": -0.02}))
    assert after[0] - before[0] == pytest.approx(-0.05) and after[1] - before[1] == pytest.approx(0.02)


@given(angle=st.floats(-0.05, 0.05))
def test_a_laser_that_is_turned_points_elsewhere(setup: Setup, lit: World, angle: float) -> None:
    bare = lit.with_body("lx_100", pose=Pose(800.0, 130.0, 0.0))
    before, far = arrival(setup, bare), 1060.0 - 180.0
    yawed = arrival(setup, upset(setup, bare, "laser", {"yaw": angle}))
    pitched = arrival(setup, upset(setup, bare, "laser", {"pitch": angle}))
    assert yawed[0] - before[0] == pytest.approx(far * np.tan(np.radians(angle)), rel=1e-6, abs=1e-9)
    assert pitched[1] - before[1] == pytest.approx(-far * np.tan(np.radians(angle)), rel=1e-6, abs=1e-9)


def test_a_polarizer_that_leaks_is_no_longer_dark_when_crossed(setup: Setup, lit: World) -> None:
    crossed = lit
    for name, x, angle in (("p1", 400.0, 0.0), ("p2", 700.0, 90.0)):
        crossed = crossed.with_body(name, pose=Pose(x, 420.0, 0.0))
        crossed = crossed.with_value(name, "angle", ObservedValue(value=angle))
    dark = arrival(setup, crossed)[2]
    leaks = arrival(setup, upset(setup, crossed, "p2", {"leak": 1e-3}))[2]
    straight = arrival(setup, crossed.with_value("p2", "angle", ObservedValue(value=0.0)))[2]
    assert leaks - dark == pytest.approx(1e-3 * straight, rel=0.01)


def test_a_camera_with_another_gain_and_a_hot_sensor_counts_otherwise(setup: Setup, lit: World) -> None:
    shut = lit.with_value("laser", "shutter", ObservedValue(value="closed"))
    shut = shut.with_value("cam", "exposure", ObservedValue(value=100.0))

    def counts(world: World) -> np.ndarray:
        reader = measurer_of(setup, "cam", "dark")
        assert reader is not None
        found = reader.read(Table(setup, Path(), world), "cam", "dark").array
        assert found is not None
        return np.asarray(found[:256], dtype=np.float64)

    usual, hot = counts(shut), counts(upset(setup, shut, "cam", {"dark": 500.0}))
    gained = counts(upset(setup, shut, "cam", {"gain": 1.5}))
    per_count = 10500 / (4095 - 64)
    assert hot.mean() - usual.mean() == pytest.approx(500.0 * 0.1 / per_count, rel=0.02)
    assert gained.mean() == pytest.approx(usual.mean(), abs=0.1)
    assert gained.std() == pytest.approx(1.5 * usual.std(), rel=0.05)


def test_nothing_that_is_read_tells_of_it_and_the_world_keeps_it(setup: Setup, lit: World, tmp_path: Path) -> None:
    changed = upset(setup, lit, "lx_100", {"up": 0.1, "pitch": 0.2, "loss": 0.3})
    assert observe(changed, "sim", "") == observe(lit, "sim", "")
    save_world(bench_at(tmp_path), changed)
    assert load_world(setup, bench_at(tmp_path))[0] == changed
    table = sim(setup, tmp_path).world
    table.reset()
    assert load_world(setup, bench_at(tmp_path))[0].components["lx_100"].unseen is None


def test_what_befell_a_part_adds_up(setup: Setup, lit: World) -> None:
    twice = upset(setup, upset(setup, lit, "cam", {"up": 0.1, "gain": 2.0}), "cam", {"up": 0.1, "gain": 2.0})
    once = upset(setup, lit, "cam", {"up": 0.2, "gain": 4.0})
    assert twice == replace(once)


@pytest.mark.parametrize(
    ("name", "by", "said"),
    [
        ("lx_100", {"upp": 0.1}, "called `upp`"),
        ("lx_100", {"loss": 1.0}, "a share from 0 to below 1"),
        ("cam", {"gain": 0.0}, "a factor above 0"),
        ("lx_100", {"up": float("nan")}, "finite"),
        ("lx_100", {"gain": 2.0}, "it is no detector"),
        ("lx_100", {"leak": 0.1}, "it is no polarizer"),
        ("lx_1", {"up": 0.1}, "no component `lx_1`"),
        ("lx_100", {"power": 0.5}, "it is no laser"),
        ("lx_100", {"optic": "half_wave_plate"}, "does not fit in the mount of lx_100"),
        ("lx_100", {"optic": "plano_convex_155"}, "this lab has no type"),
        ("p1", {"focal_length": 100.0}, "its type states none"),
    ],
)
def test_what_cannot_befall_a_part_is_refused(
    setup: Setup, tmp_path: Path, name: str, by: dict[str, float | str], said: str
) -> None:
    with pytest.raises(PicoError, match=said):
        sim(setup, tmp_path).world.upset(name, **by)


def test_a_laser_that_loses_power_shows_it_in_its_monitor_and_dirt_on_its_exit_does_not(
    setup: Setup, lit: World
) -> None:
    reader, before = measurer_of(setup, "laser", "monitor"), arrival(setup, lit)[2]
    assert reader is not None

    def monitor(world: World) -> float:
        value = reader.read(Table(setup, Path(), world), "laser", "monitor").value
        assert isinstance(value, float)
        return value

    weak, dirty = upset(setup, lit, "laser", {"power": 0.7}), upset(setup, lit, "laser", {"loss": 0.3})
    assert arrival(setup, weak)[2] == pytest.approx(0.7 * before) == pytest.approx(arrival(setup, dirty)[2])
    assert monitor(weak) == pytest.approx(0.7 * monitor(lit), rel=0.02)
    assert monitor(dirty) == pytest.approx(monitor(lit), rel=0.02)


def test_another_focal_length_and_another_lens_in_the_mount_bend_the_beam_alike(setup: Setup, lit: World) -> None:
    aside = upset(setup, lit, "lx_100", {"up": 0.1})
    longer = arrival(setup, upset(setup, aside, "lx_100", {"focal_length": 125.0}))
    other = arrival(setup, upset(setup, aside, "lx_100", {"optic": "plano_convex_125"}))
    assert longer[1] == pytest.approx(0.1 * 260.0 / 125.0, rel=0.05)
    assert other[1] == pytest.approx(longer[1], rel=0.02)
    assert arrival(setup, upset(setup, aside, "lx_100", {"focal_length": 100.0})) == arrival(setup, aside)


def test_accidents_are_listed_and_taken_back(setup: Setup, lit: World, tmp_path: Path) -> None:
    one = upset(setup, lit, "lx_100", {"focal_length": 150.0, "up": 0.1})
    both = upset(setup, slip(setup, one, "p1", "angle", 2.0), "ly_200", {"optic": "plano_convex_150_stage"})
    assert hidden(setup, both) == {
        "ly_200": {"optic": "plano_convex_150_stage"}, "lx_100": {"up": 0.1, "focal_length": pytest.approx(150.0)},
        "p1": {"angle": 2.0},
    }  # fmt: skip
    save_world(bench_at(tmp_path), both)
    assert load_world(setup, bench_at(tmp_path))[0] == both
    assert hidden(setup, clear(both, "lx_100")).keys() == {"ly_200", "p1"}
    assert clear(both) == lit


def test_changes_are_given_in_words() -> None:
    assert parse(["power=-30%", "gain=1.1", "loss=20%", "up=-0.1", "optic=plano_convex_125"]) == {
        "power": pytest.approx(0.7), "gain": 1.1, "loss": 0.2, "up": -0.1, "optic": "plano_convex_125",
    }  # fmt: skip
    with pytest.raises(PicoError, match="no number by name"):
        parse(["up=much"])
