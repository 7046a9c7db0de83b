"""An arm that is not built as the lab says misses, unless it is known how; a lab that asks for no errors has none."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from physical import bench, carry, finish, path_to, to

from pico.backends.sim.kinematic import KinematicWorld
from pico.backends.sim.mover import WorldMover
from pico.backends.sim.physics import PhysicsWorld, seeing
from pico.backends.sim.sight import Posed
from pico.backends.sim.world import World, new_world
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.simulated import ArmErrors
from pico.motion.built.correction import taken, told
from pico.motion.built.poses import reached
from pico.motion.kinematics import columns, fk
from pico.motion.types import Joints
from pico.motion.xarm7 import LIMITS
from pico.twin.arms import READS, TwinArm, arms_of
from pico.twin.physics import Twin
from pico.vision.arm import NOMINAL, UNKNOWN, ArmOffsets, FoundArm
from pico.vision.calibration import Calibration
from pico.vision.calibration_files import write_calibration
from pico.vision.nominal import camera_models
from pico.vision.rigid import apart

BAR = ArmErrors(mount_position=2.0, mount_rotation=0.3, joint_zero=0.1, tool_position=0.5)
GOAL, PART = Pose(395.0, 420.0, 90.0), "lx_125"


def wrong(errors: ArmErrors | None, name: str = "shel", **sim: object) -> Setup:
    setup = bench(name)
    settings = setup.lab.sim
    return replace(
        setup,
        lab=replace(setup.lab, sim=replace(settings, errors=replace(settings.errors, arm=errors), **sim)),  # type: ignore[arg-type]
    )


def built(setup: Setup, seed: int = 1) -> TwinArm:
    return arms_of(setup, seed)["arm1"]


def postures(setup: Setup, count: int = 40) -> np.ndarray:
    """Vertical tools all over the table, and whatever a little turning of every joint makes of them."""
    random, robot, found = np.random.default_rng(5), setup.lab.robots["arm1"], []
    while len(found) < count:
        x, y, z, yaw = random.uniform((100, 100, 60, -180), (1100, 700, 400, 180))
        found += [at for column in columns(robot, x, y, yaw)[:1] if (at := column.at(z)) is not None]
    leaning = np.array(found) + random.uniform(-0.3, 0.3, (count, 7))
    low, high = np.array(LIMITS).T
    return np.clip(np.concatenate((np.array(found), leaning)), low + 0.04, high - 0.04)


def test_a_lab_that_asks_for_none_has_perfect_arms() -> None:
    arm = built(wrong(None))
    assert arm.perfect and arm.built == NOMINAL
    joints = np.array([[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]])
    assert arm.told(joints) is joints and arm.taken(joints[0]) == tuple(joints[0])


def test_errors_are_as_large_as_the_lab_says_and_follow_from_the_seed() -> None:
    setup = wrong(BAR)
    arm, again, other = (built(setup, seed) for seed in (3, 3, 4))
    assert arm == again and arm.built != other.built
    assert np.linalg.norm(arm.built.shift) == pytest.approx(2.0)
    assert np.linalg.norm(arm.built.turn) == pytest.approx(0.3)
    assert np.linalg.norm(arm.built.tool) == pytest.approx(0.5)
    assert {abs(zero) for zero in arm.built.zeros} == {0.1}


def test_many_postures_at_once_are_reached_as_one_is() -> None:
    setup = bench()
    robot = replace(setup.lab.robots["arm1"], mount=replace(setup.lab.robots["arm1"].mount, x=0.0, y=0.0, yaw=0.0))
    many = postures(setup)
    for joints, pose in zip(many, reached(robot, many).tools, strict=True):
        point, turn = fk(tuple(joints), robot.gripper.tool)
        assert pose[:3, 3] == pytest.approx(np.array(point), abs=1e-9)
        assert pose[:3, :3] == pytest.approx(np.array(turn), abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_what_joints_are_told_brings_the_tool_of_a_known_arm_to_the_very_pose(seed: int) -> None:
    setup = wrong(BAR)
    robot, offsets, joints = setup.lab.robots["arm1"], built(setup, seed).built, postures(setup)
    corrected = told(robot, offsets, joints)
    goals, off, there = (
        reached(robot, q, o).tools for q, o in ((joints, NOMINAL), (joints, offsets), (corrected, offsets))
    )
    assert max(apart(a, b)[0] for a, b in zip(goals, off, strict=True)) > 1.5
    for goal, pose in zip(goals, there, strict=True):
        distance, angle = apart(goal, pose)
        assert distance < 1e-3 and angle < 1e-4
    assert taken(robot, offsets, corrected) == pytest.approx(joints, abs=1e-5)


def test_the_twin_and_its_cameras_have_the_arm_as_it_is_built() -> None:
    setup = wrong(BAR)
    joints: Joints = tuple(postures(setup, 1)[0])
    world = new_world(setup)
    world = replace(world, robots={"arm1": replace(world.robots["arm1"], joints=joints)})
    arm = built(setup, world.seed)
    eyes = Posed(setup, world).eyes(world)
    tool = reached(arm.robot, np.array([joints]), arm.built).tools[0]
    assert eyes.placed("hand").pose == pytest.approx(tool @ eyes.cameras["hand"].pose, abs=1e-6)
    twin = Twin(setup, {}, {"arm1": joints})
    site = twin.data.site("arm1/tcp")
    assert site.xpos * 1000 == pytest.approx(tool[:3, 3], abs=1e-6)
    assert site.xmat.reshape(3, 3) == pytest.approx(tool[:3, :3], abs=1e-9)
    known = Posed(setup, world, {"arm1": arm.built}).eyes(world).data.site("arm1/tcp")
    assert known.xpos * 1000 == pytest.approx(reached(arm.robot, np.array([joints])).tools[0][:3, 3], abs=1e-2)


def landed(setup: Setup, world: World, mover: WorldMover) -> float:
    """How far from its goal a part comes to stand [mm]."""
    work = mover.move(to_from(world), path_to(setup, world, PART, GOAL))
    if isinstance(mover, PhysicsWorld):
        finish(mover, work)
    else:
        list(work)
    pose = mover.world(world).components[PART].pose
    assert pose is not None
    return pose.distance(GOAL)


def to_from(world: World) -> object:
    start, move = world.components[PART].pose, to(PART, GOAL)
    assert start is not None
    where = {"pose": {"x": start.x, "y": start.y, "yaw": start.yaw}}
    return replace(move, arguments={**move.arguments, "from": where})


@pytest.mark.parametrize("fidelity", ["kinematic", "physics"])
def test_a_part_lands_off_its_goal_unless_the_arm_is_known(fidelity: str) -> None:
    off, right = wrong(replace(BAR, mount_rotation=0.5, joint_zero=0.2)), wrong(None)
    world = new_world(right)
    offsets = {"arm1": built(off, world.seed).built}

    def mover(setup: Setup, known: dict[str, ArmOffsets] | None) -> WorldMover:
        if fidelity == "kinematic":
            return KinematicWorld(setup, world, known)
        return PhysicsWorld(setup, world, sight=None, known=known)

    perfect, blind, knowing = (
        landed(setup, world, mover(setup, known)) for setup, known in ((right, None), (off, None), (off, offsets))
    )
    assert blind > perfect + 1.0
    assert knowing == pytest.approx(perfect, abs=0.02)


def test_encoders_read_with_noise_and_the_same_at_the_same_instant() -> None:
    setup = wrong(ArmErrors(encoder_noise=0.01))
    twin = Twin(setup, {}, {})
    assert twin.read("arm1") == twin.read("arm1") != twin.joints("arm1")
    off = []
    for _ in range(60):
        twin.advance(0.002)
        off.append(np.subtract(twin.read("arm1"), twin.joints("arm1")))
    assert math.degrees(np.std(off)) == pytest.approx(0.01 / math.sqrt(READS), rel=0.15)


def test_a_joint_with_play_follows_its_motor_late_and_nobody_reads_it() -> None:
    setup = wrong(ArmErrors(backlash=0.2))
    twin = Twin(setup, {}, {})
    start = twin.joints("arm1")
    there = tuple(q + 0.02 for q in start)
    for goal, late in ((there, 1), (start, -1)):
        twin.drive("arm1", (0.0, 0.5), (twin.joints("arm1"), goal))
        twin.advance(1.5)
        assert twin.joints("arm1") == pytest.approx(goal, abs=2e-4)
        address = twin.model.joint("arm1/joint1").qposadr[0]
        assert goal[0] - twin.data.qpos[address] == pytest.approx(late * math.radians(0.1), abs=2e-4)


def test_a_part_in_a_hand_is_known_no_better_than_the_arm(tmp_path: Path) -> None:
    setup = wrong(None, sight="pixels")
    world = new_world(setup)

    def sigma() -> float:
        sees, eyes = seeing(setup, world, tmp_path), []
        assert sees is not None
        physics = PhysicsWorld(setup, world, sight=lambda twin: eyes.append(sees(twin)) or eyes[0])
        path = path_to(setup, world, PART, GOAL)
        carry(physics, physics.move(to_from(world), path), path.seconds / 2)
        seen = eyes[0].pose_in_hand("arm1", PART)
        assert seen is not None
        return float(seen.uncertainty.position)

    assert sigma() > UNKNOWN.position, "it was never compared with what cameras over the table see"
    arms = {"arm1": FoundArm(offsets=NOMINAL, position=0.04, turn=0.02)}
    write_calibration(tmp_path, "sim", Calibration(camera_models(setup), arms=arms))
    assert 0.04 < sigma() < 0.3
