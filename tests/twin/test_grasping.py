"""Parts are picked, carried and placed by friction alone, and what goes wrong is said."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from physical import bench, carry, finish, fresh, moved_by_hand, path_to, to

from pico.backends.attempt import Failed
from pico.backends.sim.physics import PhysicsWorld
from pico.backends.sim.world import FreePose, new_world
from pico.model.pose import Pose, angle_between
from pico.model.setup import Setup

GOAL = Pose(395.0, 420.0, 30.0)


@pytest.fixture(scope="module")
def setup() -> Setup:
    return bench()


def test_a_part_comes_to_rest_where_it_should(setup: Setup) -> None:
    world, physics = fresh(setup)
    finish(physics, physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL)))
    after = physics.world(world)
    pose = after.components["lx_125"].pose
    assert pose is not None
    assert pose.distance(GOAL) < 0.4
    assert abs(angle_between(pose.yaw, GOAL.yaw)) < 0.2
    assert after.robots["arm1"].holding is None


def test_nothing_else_moves(setup: Setup) -> None:
    world, physics = fresh(setup)
    finish(physics, physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL)))
    after = physics.world(world)
    assert [n for n, body in after.components.items() if body != world.components[n]] == ["lx_125"]


def test_without_friction_the_part_is_dropped_and_named(setup: Setup) -> None:
    world, physics = fresh(setup, friction=0.0)
    with pytest.raises(Failed, match="arm1 dropped lx_125") as caught:
        finish(physics, physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL)))
    assert caught.value.diagnostic.code == "dropped"
    assert caught.value.diagnostic.address == "lx_125"
    assert physics.world(world).robots["arm1"].holding is None


def test_the_friction_of_the_pads_is_the_labs(setup: Setup) -> None:
    from dataclasses import replace

    slippery = replace(setup, lab=replace(setup.lab, sim=replace(setup.lab.sim, pad_friction=0.0)))
    world, physics = fresh(slippery)
    with pytest.raises(Failed, match="dropped lx_125"):
        finish(physics, physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL)))


def test_fingers_that_close_on_nothing_are_a_missed_grasp(setup: Setup) -> None:
    world = new_world(setup)
    path = path_to(setup, world, "lx_125", GOAL)
    elsewhere = moved_by_hand(world, "lx_125", 200.0)
    physics = PhysicsWorld(setup, elsewhere)
    with pytest.raises(Failed, match="missed lx_125") as caught:
        finish(physics, physics.move(to("lx_125", GOAL), path))
    assert caught.value.diagnostic.code == "missed-grasp"
    assert physics.world(elsewhere).components["lx_125"] == elsewhere.components["lx_125"]


def test_a_part_that_is_let_go_in_the_air_falls_and_is_reported(setup: Setup) -> None:
    world, physics = fresh(setup)
    work = physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL))
    while physics.carried("arm1") is None or physics.twin.placement("lx_125").position[2] < 0.14:
        physics.advance(next(work))
    physics.twin.grip("arm1", 84.0)
    with pytest.raises(Failed, match="dropped lx_125"):
        finish(physics, work)
    body = physics.world(world).components["lx_125"]
    assert body.presence in ("toppled", "seen")
    assert physics.twin.placement("lx_125").position[2] < 0.06


def test_a_stopped_arm_keeps_what_it_holds_also_in_the_next_session(setup: Setup) -> None:
    world, physics = fresh(setup)
    work = physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL))
    while physics.carried("arm1") is None or physics.twin.placement("lx_125").position[2] < 0.1:
        physics.advance(next(work))
    work.close()
    physics.advance(0.5)
    held = physics.world(world)
    assert held.robots["arm1"].holding == "lx_125"
    assert held.components["lx_125"].presence == "held"
    later = PhysicsWorld(setup, held)
    later.advance(1.0)
    after = later.world(held)
    assert after.robots["arm1"].holding == "lx_125"
    before, now = held.components["lx_125"].free, after.components["lx_125"].free
    assert before is not None
    assert now is not None
    assert now.position == pytest.approx(before.position, abs=0.5)


def test_a_part_that_lies_on_its_side_still_does_in_the_next_session(setup: Setup) -> None:
    c = 0.5**0.5
    free = FreePose(position=(700.0, 300.0, 40.0), quaternion=(c, c, 0.0, 0.0))
    world = new_world(setup).with_body("p1", presence="toppled", pose=Pose(700, 300, 0), free=free)
    physics = PhysicsWorld(setup, world)
    physics.advance(2.0)
    body = physics.world(world).components["p1"]
    assert body.presence == "toppled"
    assert body.free is not None
    assert body.free.position[2] < 40.0


def test_a_part_that_leans_a_little_still_does_in_the_next_session(setup: Setup) -> None:
    half = math.radians(2) / 2
    free = FreePose(position=(700.0, 300.0, 2.0), quaternion=(math.cos(half), math.sin(half), 0.0, 0.0))
    world = new_world(setup).with_body("p1", pose=Pose(700, 300, 0), free=free)
    body = PhysicsWorld(setup, world).world(world).components["p1"]
    assert body.presence == "seen" and body.free is not None
    assert body.free.position == pytest.approx(free.position) and body.free.quaternion == pytest.approx(free.quaternion)


def test_a_magnet_holds_a_part_until_it_is_lifted(setup: Setup) -> None:
    world, physics = fresh(setup)
    work, pulls = (
        physics.move(to("lx_125", GOAL), path_to(setup, world, "lx_125", GOAL)),
        physics.twin.data.body("lx_125"),
    )
    assert setup.seating_of("lx_125") == "magnet"
    while physics.carried("arm1") is None:
        physics.advance(next(work))
        assert physics.twin.placement("lx_125").position[2] > 1e-3 or pulls.xfrc_applied[2] < -5
    physics.advance(next(work))
    assert pulls.xfrc_applied[2] == 0


@pytest.mark.filterwarnings("error")
def test_a_part_that_leans_on_another_is_nothing_to_warn_of(
    setup: Setup, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    c, world = 0.5**0.5, new_world(setup)
    standing = world.components["p1"].pose
    assert standing is not None
    free = FreePose(position=(standing.x + 100, standing.y, 30.0), quaternion=(c, 0.0, -c, 0.0))
    leaning = world.with_body("p2", presence="toppled", pose=standing, free=free)
    physics = PhysicsWorld(setup, leaning)
    physics.advance(2.0)
    after = physics.world(leaning)
    assert after.components["p1"].pose != standing  # it was touched
    PhysicsWorld(setup, after)
    assert "".join(capfd.readouterr()) == ""
    assert not list(tmp_path.iterdir())


def test_a_part_pushed_off_the_table_is_missing(setup: Setup) -> None:
    world = new_world(setup).with_body("p1", pose=Pose(1240, 200, 0))
    physics = PhysicsWorld(setup, world)
    physics.twin.data.qvel[:] += 1e-3  # wakes it
    physics.advance(1.0)
    body = physics.world(world).components["p1"]
    assert (body.presence, body.pose) == ("missing", None)


def test_same_question_same_answer(setup: Setup) -> None:
    found = []
    for _ in range(2):
        world, physics = fresh(setup)
        finish(physics, physics.move(to("p1", GOAL), path_to(setup, world, "p1", GOAL)))
        found.append(physics.world(world))
    assert found[0] == found[1]


def test_how_time_is_cut_makes_no_difference_to_what_rests(setup: Setup) -> None:
    world, physics = fresh(setup)
    carry(physics, physics.move(to("p1", GOAL), path_to(setup, world, "p1", GOAL)), 1.0)
    _, other = fresh(setup)
    work = other.move(to("p1", GOAL), path_to(setup, world, "p1", GOAL))
    seconds = 1.0
    while seconds > 0:
        wait = next(work)
        for _ in range(5):
            other.advance(wait / 5)
        seconds -= wait
    assert other.twin.joints("arm1") == pytest.approx(physics.twin.joints("arm1"), abs=1e-3)


@pytest.mark.slow
def test_random_moves_are_placed_within_half_a_millimetre() -> None:
    import sys
    from pathlib import Path

    sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "benchmarks"))
    from pick_and_place import Run

    done = list(Run(bench(), 5).trials(25))
    assert len(done) == 25
    assert [t.failure for t in done if t.failure] == []
    assert max(t.data["error_mm"] for t in done) < 0.5
    assert max(t.data["error_deg"] for t in done) < 0.5
