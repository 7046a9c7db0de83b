"""A part that is put down sits as it may: exactly in kinematic fidelity unless the lab asks, and no look tells how."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from bench_at import bench_at
from benches import shel
from physical import finish, path_to, to

from pico.backends.sim.kinematic import KinematicWorld
from pico.backends.sim.lighted import unseen_of
from pico.backends.sim.physics import PhysicsWorld
from pico.backends.sim.store import load_world, save_world, world_from_json
from pico.backends.sim.world import FreePose, World, WorldBody, new_world, observe
from pico.geometry.seat import Seat, drawn
from pico.model.pose import Pose
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.simulated import SimErrors

SETUP, _ = shel()
PART, GOAL = "lx_100", Pose(520.0, 320.0, 0.0)


def asking(seat: float | None) -> Setup:
    sim = replace(SETUP.lab.sim, errors=SimErrors(seat=seat))
    return replace(SETUP, lab=replace(SETUP.lab, sim=sim))


def carried(setup: Setup, world: World, goal: Pose = GOAL) -> World:
    mover = KinematicWorld(setup, world)
    operation = to(PART, goal)
    arguments = {**operation.arguments, "from": {"pose": as_json(world.components[PART].pose)}}
    finish(mover, mover.move(replace(operation, arguments=arguments), path_to(setup, world, PART, goal)))  # type: ignore[arg-type]
    return mover.world(world)


def test_kinematic_places_exactly_and_upright() -> None:
    body = carried(SETUP, new_world(SETUP)).components[PART]
    assert (body.pose, body.seat) == (GOAL, None)


def test_where_the_lab_asks_each_placement_errs_anew_and_the_same_for_a_seed() -> None:
    setup = asking(2.0)
    first = carried(setup, new_world(setup))
    error = drawn(setup, PART, first.seed, 1, 2.0)
    assert first.components[PART].pose == error.of(GOAL)
    assert first.components[PART].seat == error.seat(1)
    assert carried(setup, new_world(setup)).components[PART] == first.components[PART]
    again = carried(setup, first, Pose(560.0, 300.0, 0.0)).components[PART]
    assert again.seat == drawn(setup, PART, first.seed, 2, 2.0).seat(2) != first.components[PART].seat


def test_what_physics_left_leaning_is_upright_once_kinematic_puts_it_down() -> None:
    world = new_world(SETUP).with_body(PART, seat=Seat(pitch=0.1, height=0.2, count=4))
    seat = carried(SETUP, world).components[PART].seat
    assert seat is not None and seat.level and seat.count == 5


@pytest.mark.parametrize(("asked", "times"), [(None, 1.0), (0.0, 0.0)])
def test_physics_seats_a_part_as_its_type_repeats(asked: float | None, times: float) -> None:
    setup = asking(asked)
    world = new_world(setup)
    physics = PhysicsWorld(setup, world)
    finish(physics, physics.move(to(PART, GOAL), path_to(setup, world, PART, GOAL)))
    body = physics.world(world).components[PART]
    assert body.seat == drawn(setup, PART, world.seed, 1, times).seat(1)
    assert body.pose is not None and body.pose.distance(drawn(setup, PART, world.seed, 1, times).of(GOAL)) < 0.05


def test_a_look_tells_nothing_of_the_seat() -> None:
    world = new_world(SETUP)
    leaning = world.with_body(PART, seat=Seat(pitch=0.2, roll=-0.1, height=0.3, count=1))
    assert observe(leaning, "sim", "now") == observe(world, "sim", "now")


def test_a_seat_outlives_the_process_and_old_worlds_have_none(tmp_path: Path) -> None:
    world = new_world(SETUP).with_body(PART, seat=Seat(pitch=0.2, roll=-0.1, height=0.3, count=1))
    save_world(bench_at(tmp_path), world)
    assert load_world(SETUP, bench_at(tmp_path)) == (world, ())
    old = json.loads(json.dumps(as_json(world)))
    old["components"][PART].pop("seat")
    assert world_from_json(old).components[PART].seat is None
    with pytest.raises(ValueError, match="no finite number"):
        world_from_json({**old, "components": {PART: {**old["components"][PART], "seat": {
            "pitch": "1", "roll": 0, "height": 0, "count": 1}}}})  # fmt: skip


def test_light_finds_what_physics_left_off_the_plane_and_how_it_sits() -> None:
    free = FreePose(position=(520, 320, 0.4), quaternion=(1.0, 0.0, 0.001, 0.0))
    found = unseen_of(SETUP, PART, WorldBody(type="x", pose=GOAL, free=free, seat=Seat(pitch=0.1, height=0.1, count=2)))
    assert found is not None
    pitch = 0.1 + 0.1146
    assert (found.pitch, found.roll, found.up) == pytest.approx((pitch, 0.0, 0.5), abs=1e-3)
    assert found.ahead == pytest.approx(70 * math.radians(pitch), rel=1e-3)
    assert unseen_of(SETUP, PART, WorldBody(type="x", pose=GOAL, seat=Seat(count=2))) is None
