"""A hand that stopped dead among neighbours, its fingers anywhere: the next session finds it so, and harms nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest
from physical import bench, carry, finish, path_to, to

from pico.backends.attempt import Failed
from pico.backends.checks import standing
from pico.backends.sim.hand import remove
from pico.backends.sim.kinematic import KinematicWorld
from pico.backends.sim.physics import PhysicsWorld
from pico.backends.sim.world import World, new_world
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.motion.arms import ArmMotion
from pico.motion.types import MovePath
from pico.twin.sight import Exact

PART, NEIGHBOR = "p1", "p2"
GOAL = Pose(700.0, 450.0, 0.0)
NEAR = 62.0
"""So near the neighbour may stand along the jaws for the fingers to have room, opened as far as planned [mm]."""


@pytest.fixture(scope="module")
def setup() -> Setup:
    return bench()


@pytest.fixture(scope="module")
def world(setup: Setup) -> World:
    """Return the bench with two parts close together."""
    there = new_world(setup).with_body(PART, pose=Pose(500, 300, 0))
    return there.with_body(NEIGHBOR, pose=Pose(500 + NEAR, 300, 0))


def stopped(setup: Setup, world: World, height: float, opening: float) -> World:
    """Return what a process leaves behind that was killed as soon as the hand was so low and so far closed [mm]."""
    physics = PhysicsWorld(setup, world)
    work = physics.move(to(PART, GOAL), path_to(setup, world, PART, GOAL))
    while physics.twin.opening("arm1") > opening or physics.twin.data.site("arm1/tcp").xpos[2] * 1000 > height:
        carry(physics, work, 0.01)
    left = physics.world(world)
    assert left.robots["arm1"].holding is None
    return left


def off(world: World, now: World, name: str) -> float:
    """Return how far a part, which must stand, is from where it was [mm]."""
    before, after = world.components[name].pose, now.components[name].pose
    assert now.components[name].presence == "seen"
    assert before is not None
    assert after is not None
    return after.distance(before)


@pytest.mark.parametrize(
    ("height", "opening"), [(140, 55.0), (120, 55.0), (101, 55.0), (101, 50.0), (101, 40.0), (101, 33.9)]
)
def test_fingers_are_as_far_apart_as_they_were_and_push_no_neighbour(
    setup: Setup, world: World, height: float, opening: float
) -> None:
    left = stopped(setup, world, height, opening)
    physics = PhysicsWorld(setup, left)
    assert physics.world(left).openings == left.openings
    physics.advance(0.5)
    later = physics.world(left)
    assert later.openings["arm1"] == pytest.approx(left.openings["arm1"], abs=0.3)
    assert off(left, later, NEIGHBOR) == 0.0
    assert off(left, later, PART) < 0.01


@pytest.mark.parametrize("again", ["park", "move"])
def test_a_hand_that_closed_on_a_part_opens_before_it_moves_off(setup: Setup, world: World, again: str) -> None:
    left = stopped(setup, world, 101.0, 33.9)
    physics, robot = PhysicsWorld(setup, left), left.robots["arm1"]
    if again == "move":
        other = Pose(300, 450, 0)
        finish(physics, physics.move(to("ly_200", other), path_to(setup, left, "ly_200", other)))
    else:
        path = ArmMotion(setup).park("arm1", robot.joints, standing(setup, left))
        assert isinstance(path, MovePath), path
        finish(physics, physics.park(path))
    assert off(world, physics.world(left), PART) < 0.3
    assert off(world, physics.world(left), NEIGHBOR) == 0.0


class Blind(Exact):
    """Sees nothing between open fingers."""

    def refer(self, robot: str, component: str, stands: Pose | None) -> bool:
        return False


def test_a_hand_that_leaves_a_part_alone_opens_no_further_than_it_has_room(setup: Setup, world: World) -> None:
    physics = PhysicsWorld(setup, world, sight=Blind)
    with pytest.raises(Failed, match="it was left there"):
        finish(physics, physics.move(to(PART, GOAL), path_to(setup, world, PART, GOAL)))
    assert physics.world(world).components == world.components


def test_a_kinematic_world_knows_nothing_of_fingers(setup: Setup, world: World) -> None:
    left = replace(world, openings={"arm1": 34.0})
    assert KinematicWorld(setup, left).world(left).openings == {}


def test_a_part_that_somebody_took_away_is_told_before_a_hand_goes_for_it(setup: Setup, world: World) -> None:
    path = path_to(setup, world, PART, GOAL)
    gone = remove(setup, world, PART)
    physics = PhysicsWorld(setup, gone)
    with pytest.raises(Failed) as failed:
        finish(physics, physics.move(to(PART, GOAL), path))
    assert failed.value.diagnostic.code == "missing"
