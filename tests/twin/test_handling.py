"""Placements are corrected by what sees the part in the hand; what is not seen is not placed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from physical import bench, carry, finish, fresh, path_to, to

from pico.backends.attempt import Failed
from pico.backends.checks import standing
from pico.backends.sim.physics import PhysicsWorld, seeing
from pico.backends.sim.world import World, new_world
from pico.manifest.catalog import packaged_type
from pico.model.observation import Uncertainty
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.simulated import SimErrors
from pico.motion.arms import ArmMotion
from pico.motion.kinematics import tool_pose
from pico.motion.types import MovePath
from pico.twin.scene import TIMESTEP
from pico.twin.sight import Exact, InHand

GOAL = Pose(395.0, 420.0, 30.0)
PART = "lx_125"


@pytest.fixture(scope="module")
def setup() -> Setup:
    return bench()


def changed(setup: Setup, seating: str = "free", **sim: object) -> Setup:
    """Return the bench with another seating of the part, and other settings of the simulation."""
    kind = setup.lab.inventory[PART].type
    catalog = {**setup.catalog, kind: replace(setup.catalog[kind], seating=seating)}
    return replace(setup, catalog=catalog, lab=replace(setup.lab, sim=replace(setup.lab.sim, **sim)))


def placed(setup: Setup, shift: float, sight: object = Exact) -> tuple[dict[str, float], Pose | None]:
    """Place a part that stands `shift` mm beside where the path has it; return what was said and where it stands.

    On the way the tool is never faster than the lab allows, and nearly as fast.
    """
    robots = {name: replace(robot, tool_speed=250.0) for name, robot in setup.lab.robots.items()}
    setup = replace(setup, lab=replace(setup.lab, robots=robots))
    world = new_world(setup)
    path, pose = path_to(setup, world, PART, GOAL), world.components[PART].pose
    assert pose is not None
    there = world.with_body(PART, pose=replace(pose, y=pose.y + shift))  # along the pads, which don't center it
    physics = PhysicsWorld(setup, there, sight=sight)  # type: ignore[arg-type]
    tool, ways = physics.twin.data.site("arm1/tcp").xpos, []
    physics.twin.after_step = lambda: ways.append(tool * 1000)
    data = finish(physics, physics.move(to(PART, GOAL), path), PART, GOAL)
    fastest = np.linalg.norm(np.diff(ways, axis=0), axis=1).max() / TIMESTEP
    assert 0.9 * 250 < fastest < 250
    return data, physics.world(there).components[PART].pose


def test_without_a_sight_the_error_of_the_pick_is_that_of_the_placement(setup: Setup) -> None:
    data, _ = placed(changed(setup), 2.0, None)
    assert data["error_mm"] == pytest.approx(2.0, abs=0.5)
    assert data["correction_mm"] == 0.0


def test_a_sight_takes_the_error_of_the_pick_out(setup: Setup) -> None:
    data, _ = placed(changed(setup), 2.0)
    assert data["error_mm"] < 0.15
    assert data["correction_mm"] == pytest.approx(2.0, abs=0.5)


def test_pictures_of_cameras_that_are_wrong_place_within_half_a_millimetre(setup: Setup, tmp_path: Path) -> None:
    errors = SimErrors(camera_position=0.2, camera_rotation=0.05, focal_length=0.005)
    wrong = changed(setup, errors=errors, sight="pixels")
    data, _ = placed(wrong, 2.0, seeing(wrong, new_world(wrong), tmp_path))
    assert data["error_mm"] < 0.3
    assert data["error_deg"] < 0.2


def test_black_pictures_make_it_leave_the_part_alone(setup: Setup, tmp_path: Path) -> None:
    dark = changed(setup, errors=SimErrors(lost_frames=1.0), sight="pixels")
    world = new_world(dark)
    physics = PhysicsWorld(dark, world, sight=seeing(dark, world, tmp_path))
    with pytest.raises(Failed, match=f"no camera sees {PART} in the hand of arm1: it was left there") as caught:
        finish(physics, physics.move(to(PART, GOAL), path_to(dark, world, PART, GOAL)))
    assert caught.value.diagnostic.code == "unseen"
    assert physics.world(world).components[PART] == world.components[PART]


class Blinded(Exact):
    """Sees a part until it is lifted."""

    def pose_in_hand(self, robot: str, component: str) -> InHand | None:
        return None


class Slipped(Exact):
    """Sees a part 12 mm from where it is."""

    def pose_in_hand(self, robot: str, component: str) -> InHand | None:
        seen = super().pose_in_hand(robot, component)
        assert seen is not None
        return InHand(Pose(seen.pose.x + 12.0, seen.pose.y, seen.pose.yaw), seen.height, Uncertainty())


@pytest.mark.parametrize(("sight", "code", "off"), [(Blinded, "unseen", 0.0), (Slipped, "slipped", 12.0)])
def test_what_is_not_where_it_should_be_in_the_hand_goes_back(
    setup: Setup, sight: object, code: str, off: float
) -> None:
    world = new_world(setup)
    start = world.components[PART].pose
    assert start is not None
    physics = PhysicsWorld(setup, world, sight=sight)  # type: ignore[arg-type]
    with pytest.raises(Failed, match="put back") as caught:
        finish(physics, physics.move(to(PART, GOAL), path_to(setup, world, PART, GOAL)))
    after = physics.world(world)
    pose = after.components[PART].pose
    assert caught.value.diagnostic.code == code
    assert pose is not None
    assert pose.distance(start) == pytest.approx(off, abs=2.0)
    assert after.robots["arm1"].holding is None


def test_a_seat_pulls_within_its_repeatability_and_the_same_way_for_a_seed(setup: Setup) -> None:
    free, _ = placed(changed(setup), 0.0)
    first, pose = placed(changed(setup, "magnet"), 0.0)
    second, again = placed(changed(setup, "magnet"), 0.0)
    assert free["error_mm"] < 0.05 < first["error_mm"] < 0.5
    assert (first, pose) == (second, again)


def test_a_part_that_its_seat_has_pulled_is_seen_where_it_is(setup: Setup) -> None:
    _, physics = fresh(setup)
    physics.advance(1.0)  # it sleeps
    physics.twin.pull(PART, 0.4, -0.3, 0.0)
    seen = physics.twin.data.body(PART).xpos[:2] * 1000
    pose = physics.twin.placement(PART).pose
    assert seen == pytest.approx((pose.x, pose.y), abs=1e-3)


def test_v_grooves_bring_a_part_to_the_middle_of_the_hand(setup: Setup) -> None:
    kind = setup.lab.inventory[PART].type
    grooved = replace(packaged_type("plano_convex_100_v_groove"), name=kind, seating="free")
    data, _ = placed(replace(setup, catalog={**setup.catalog, kind: grooved}), 2.0, None)
    assert data["error_mm"] < 0.3


def test_a_grip_without_room_for_a_groove_is_refused() -> None:
    flat = packaged_type("plano_convex_100").geometry
    assert flat.grasp is not None
    with pytest.raises(ValueError, match="no V-groove for fingers of 22 mm fits a grip of 34 mm held at 34 mm"):
        replace(flat, grasp=replace(flat.grasp, fixture="v_groove"))


def test_a_part_that_is_in_the_hand_is_set_down(setup: Setup) -> None:
    world, physics = fresh(setup)
    work = physics.move(to(PART, GOAL), path_to(setup, world, PART, GOAL))
    while physics.carried("arm1") is None or physics.twin.placement(PART).position[2] < 0.1:
        physics.advance(next(work))
    work.close()
    physics.advance(0.5)
    now = physics.world(world)
    data = finish(physics, physics.move(to(PART, GOAL), way_down(setup, now)), PART, GOAL)
    assert data["error_mm"] < 0.5
    assert physics.world(now).robots["arm1"].holding is None


def way_down(setup: Setup, world: World) -> MovePath:
    """Return how the part that the arm holds comes to its goal."""
    held, joints = world.components[PART].pose, world.robots["arm1"].joints
    assert held is not None
    path = ArmMotion(setup).set_down("arm1", PART, held, GOAL, standing(setup, world), joints)
    assert isinstance(path, MovePath), path
    return path


def in_hand(physics: PhysicsWorld) -> tuple[Pose, float]:
    """Return where the part is in the hand, and its base above the tool center point [mm]."""
    place = physics.twin.placement(PART)
    x, y, z, yaw = tool_pose(bench().lab.robots["arm1"], physics.twin.joints("arm1"))
    return Pose(x, y, yaw).inverse().compose(place.pose), place.position[2] * 1000 - z


@pytest.mark.parametrize("seconds", [3.2, 3.5, 3.8, 4.1, 4.6])
def test_a_hand_that_stops_dead_in_mid_motion_holds_its_part_as_before_and_sets_it_down(
    setup: Setup, seconds: float
) -> None:
    world, physics = fresh(setup)
    carry(physics, physics.move(to(PART, GOAL), path_to(setup, world, PART, GOAL)), seconds)
    before, left = in_hand(physics), physics.world(world)
    later = PhysicsWorld(setup, left)
    assert physics.carried("arm1") is not None
    assert later.carried("arm1") == physics.carried("arm1")
    later.advance(0.3)
    assert later.twin.joints("arm1") == pytest.approx(left.robots["arm1"].joints, abs=5e-5)  # it bears the part
    assert in_hand(later)[0].distance(before[0]) < 0.2
    assert in_hand(later)[1] == pytest.approx(before[1], abs=0.05)
    at_once = PhysicsWorld(setup, left)
    data = finish(at_once, at_once.move(to(PART, GOAL), way_down(setup, left)), PART, GOAL)
    assert data["error_mm"] < 0.5
