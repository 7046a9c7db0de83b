"""The world behind emulated devices: what arms do to it with their fingers, and what it keeps."""

from __future__ import annotations

from pathlib import Path

import pytest
from bench_at import bench_at
from emulated_lab import wired_lab

from pico.backends.emulated.behind import OfPart
from pico.backends.emulated.world import EmulatedWorld
from pico.backends.sim.store import world_path
from pico.drivers.registry import driver
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion
from pico.motion.types import Joints, MovePath, StandingObject

GOAL = Pose(395, 420, 0)


@pytest.fixture
def setup(tmp_path: Path) -> Setup:
    return wired_lab(tmp_path)


@pytest.fixture
def path(setup: Setup) -> MovePath:
    """The way of lx_125 from its slot onto the table."""
    start = setup.lab.slots["storage/a3"].pose
    standing = {"lx_125": StandingObject(start, setup.type_of("lx_125").geometry)}
    found = ArmMotion(setup).move("arm1", "lx_125", start, GOAL, 0.0, standing)
    assert isinstance(found, MovePath)
    return found


def at_the_end_of(path: MovePath, name: str) -> Joints:
    return next(s for s in path.segments if s.name == name).joints[-1]


def gripped(world: EmulatedWorld, path: MovePath, opened: float = 55.0) -> float:
    world.moved("arm1", at_the_end_of(path, "descend"))
    world.fingers("arm1", at_the_end_of(path, "descend"), opened, 84.0)
    return world.fingers("arm1", at_the_end_of(path, "grip"), 30.0, opened)


def test_fingers_close_on_the_part_between_them_and_put_it_down_where_they_open(
    setup: Setup, tmp_path: Path, path: MovePath
) -> None:
    world, grasp = EmulatedWorld(setup, bench_at(tmp_path, "emulated")), setup.type_of("lx_125").geometry.grasp
    assert grasp is not None
    assert gripped(world, path) == grasp.width == world.width("arm1")
    assert world.world().robots["arm1"].holding == "lx_125"
    world.moved("arm1", at_the_end_of(path, "transit"))
    carried = world.world().components["lx_125"]
    assert carried.presence == "held" and carried.pose is not None and carried.pose.distance(GOAL) < 1e-6
    world.fingers("arm1", at_the_end_of(path, "lower"), 55.0, grasp.width)
    put = world.world().components["lx_125"]
    assert put.presence == "seen" and put.pose is not None and put.pose.distance(GOAL) < 1e-6
    assert world.world().robots["arm1"].holding is None and world.width("arm1") == 55.0


def test_a_part_that_is_let_go_of_high_above_the_table_does_not_stand(
    setup: Setup, tmp_path: Path, path: MovePath
) -> None:
    world = EmulatedWorld(setup, bench_at(tmp_path, "emulated"))
    gripped(world, path)
    world.fingers("arm1", at_the_end_of(path, "transit"), 60.0, world.width("arm1"))
    assert world.world().components["lx_125"].presence == "toppled"


def test_fingers_that_close_beside_a_part_close_on_nothing(setup: Setup, tmp_path: Path, path: MovePath) -> None:
    world = EmulatedWorld(setup, bench_at(tmp_path, "emulated"))
    assert world.fingers("arm1", at_the_end_of(path, "transit"), 30.0, 55.0) == 30.0
    assert world.world().robots["arm1"].holding is None


def test_the_world_is_there_again_with_what_a_hand_held_when_its_process_was_killed(
    setup: Setup, tmp_path: Path, path: MovePath
) -> None:
    gripped(EmulatedWorld(setup, bench_at(tmp_path, "emulated")), path)  # nothing is closed
    again = EmulatedWorld(setup, bench_at(tmp_path, "emulated"))
    assert again.world().robots["arm1"].holding == "lx_125"
    again.moved("arm1", at_the_end_of(path, "transit"))
    carried = again.world().components["lx_125"].pose
    assert carried is not None and carried.distance(GOAL) < 1e-6
    assert not world_path(bench_at(tmp_path)).exists(), "the simulator's table is another"


def test_who_only_looks_writes_nothing(setup: Setup, tmp_path: Path) -> None:
    world = EmulatedWorld(setup, bench_at(tmp_path, "emulated"))
    world.set_value("p1", "angle", world.value("p1", "angle") or 0.0)
    world.store()
    assert not (tmp_path / ".pico").exists()


def test_the_clock_goes_at_the_pace_of_the_world(setup: Setup, tmp_path: Path) -> None:
    wall = [100.0]
    world = EmulatedWorld(setup, bench_at(tmp_path, "emulated"), pace=10, wall=lambda: wall[0])
    wall[0] += 3.0
    assert world.now() == pytest.approx(30.0)


def test_a_device_has_its_own_numbers_of_a_tunable_and_keeps_what_it_was_told(setup: Setup, tmp_path: Path) -> None:
    assert setup.wiring is not None
    world, entry = EmulatedWorld(setup, bench_at(tmp_path, "emulated")), setup.wiring.devices["ly_150_y"]
    behind = OfPart(world, "ly_150_y", entry, "ly_150", driver(entry.driver))
    behind.write("position", 2.2)
    assert world.value("ly_150", "stage_y") == pytest.approx(0.2)
    assert behind.read("position") == pytest.approx(2.2)
    assert behind.read("stuck") is None
    behind.write("jog", 143361)
    again = OfPart(
        EmulatedWorld(setup, bench_at(tmp_path, "emulated")), "ly_150_y", entry, "ly_150", driver(entry.driver)
    )
    assert again.read("jog") == 143361
    box = setup.wiring.devices["laser_shutter"]
    shutter = OfPart(world, "laser_shutter", box, "laser", driver(box.driver))
    shutter.write("open", True)
    assert world.value("laser", "shutter") == "open" and shutter.read("open") is True
