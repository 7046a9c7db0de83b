from __future__ import annotations

import math
import random
from dataclasses import replace

import mujoco
import pytest
from benchtop import DISC, PART, TALL, TRIANGLE, bench, stands
from oracles.inverse import ik

from pico.model.lab import Box2, KeepOut, Margins
from pico.model.pose import Pose
from pico.model.robot import Mount, Robot
from pico.motion.arm import ARM_BIT, WORLD_BIT, attach_arm
from pico.motion.arms import ArmMotion
from pico.motion.engine import add_solids
from pico.motion.scene import FREE, Scene, within_reach

ARM = bench().lab.robots["arm1"]
THINGS = (PART, DISC, TALL, TRIANGLE)


def test_moved_components_are_hit_exactly_as_in_a_fresh_model():
    rng = random.Random(5)
    scene = Scene(bench(), "arm1", dict.fromkeys(THINGS, 3))
    hits = 0
    for _ in range(25):
        at = {
            f"t{i}": (rng.choice(THINGS), Pose(480 + rng.uniform(-60, 60), 300 + 130 * i, rng.uniform(-180, 180)))
            for i in range(3)
        }
        standing = stands(at=at)
        scene.arrange(standing)
        scene.open(50.0)
        for _ in range(8):
            joints = ik(ARM, 480 + rng.uniform(-80, 80), rng.uniform(300, 560), rng.uniform(60, 250), 0)[0]
            _, hit = scene.look(joints)
            depth = _fresh_depth(standing, joints)
            assert (hit is not None and hit.gap < 0) == (depth > 1e-6)
            if depth > 1e-6:
                hits += 1
                assert hit.obstacle in standing or hit.kind != "component"
    assert hits > 20


def _fresh_depth(standing, joints):
    """How deep anything overlaps in a model compiled for just this arrangement [m]."""
    spec = mujoco.MjSpec()
    world = {"contype": WORLD_BIT, "conaffinity": ARM_BIT}
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.6, 0.45, 0.05], pos=[0.6, 0.45, -0.05], **world)
    for name, thing in standing.items():
        half = math.radians(thing.pose.yaw) / 2
        pos = [thing.pose.x / 1000, thing.pose.y / 1000, 0]
        body = spec.worldbody.add_body(name=name, pos=pos, quat=[math.cos(half), 0, 0, math.sin(half)])
        add_solids(spec, body, thing.geometry, **world)
    attach_arm(spec, "arm1", ARM)
    model = spec.compile()
    data = mujoco.MjData(model)
    at = model.joint("arm1/joint1").qposadr[0]
    data.qpos[at : at + 9] = [*joints, 0.025, 0.025]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    base = model.body("arm1/base").id
    return max((-c.dist for c in data.contact if base not in [model.geom_bodyid[g] for g in c.geom]), default=0.0)


@pytest.mark.parametrize("yaw", [0.0, 35.0, 90.0])
def test_the_part_in_hand_is_where_the_hand_takes_it(yaw):
    """A post 8 mm beside the held part's edge is 8 mm away, whatever the grasp yaw."""
    scene = Scene(bench(), "arm1", {PART: 1, DISC: 1, TALL: 1})
    scene.hold(PART, yaw)
    scene.open(34.0)
    part = Pose(520, 420, 12)
    joints = ik(ARM, part.x, part.y, 140, part.yaw + yaw)[0]  # its foot 40 mm above the table
    for gap in (-3.0, 4.0, 8.0):
        x, y = part.apply(30 + gap + 25, 0)
        scene.arrange(stands(at={"post": (DISC, Pose(x, y))}))
        slack, hit = scene.look(joints)
        assert slack == pytest.approx(gap - 2.0, abs=0.05)
        assert (hit is not None) == (gap < 2.0)
    scene.hold(None)
    x, y = part.apply(30 - 3 + 25, 0)
    scene.arrange(stands(at={"post": (DISC, Pose(x, y))}))
    assert scene.look(joints)[1] is None


def test_what_is_hit_is_named_with_its_depth():
    setup = bench(keep_out={"lamp": KeepOut(area=Box2(x=(700, 800), y=(300, 400)), z=(100, 400))})
    scene = Scene(setup, "arm1", {TALL: 1})
    scene.arrange(stands(at={"post": (TALL, Pose(520, 420, 0))}))
    scene.open(40.0)
    _, hit = scene.look(ik(ARM, 520, 420, 250, 0)[0])
    assert hit is not None and hit.obstacle == "post" and hit.kind == "component" and hit.gap < -10
    _, hit = scene.look(ik(ARM, 750, 350, 250, 0)[0])
    assert hit is not None and hit.obstacle == "lamp" and hit.kind == "keep_out"
    _, hit = scene.look(ik(ARM, 600, 500, 6, 0)[0])
    assert hit is not None and (hit.part, hit.obstacle) == ("finger", "table")
    assert hit.gap == pytest.approx(-4.0, abs=0.01)


def test_the_other_arm_is_an_obstacle_where_it_is_parked():
    robots = {"arm1": ARM, "arm2": Robot(mount=Mount(x=480, y=140, yaw=90))}
    scene = Scene(bench(robots=robots), "arm1", {})
    assert scene.look(ArmMotion(bench(robots=robots)).park_joints("arm1"))[1] is None
    _, hit = scene.look(ik(ARM, 480, 335, 260, 0)[0])
    assert hit is not None and (hit.kind, hit.obstacle) == ("robot", "arm2")


def test_far_from_everything_the_slack_is_all_that_can_be_seen():
    scene = Scene(bench(), "arm1", {})
    assert scene.look(ArmMotion(bench()).park_joints("arm1")) == (FREE, None)


def test_only_what_stands_within_reach_is_in_the_scene():
    standing = stands(at={"near": (PART, Pose(500, 300)), "far": (PART, Pose(3000, 300))})
    assert list(within_reach(bench(), "arm1", standing, 850)) == ["near"]


def test_a_scene_is_compiled_again_only_for_what_has_no_place():
    motion = ArmMotion(bench())
    few = stands(at={"a": (PART, Pose(400, 400))})
    many = stands(at={f"t{i}": (TALL, Pose(100 + 100 * i, 200)) for i in range(4)})
    first = motion._scene("arm1", few)
    assert motion._scene("arm1", few) is first
    second = motion._scene("arm1", few | many)
    assert second is not first
    assert motion._scene("arm1", few | many) is second
    assert motion._scene("arm1", few) is second


def test_margins_wider_than_usual_are_kept_too():
    lab = replace(bench().lab, margins=Margins(body=30, fingers=25))
    scene = Scene(replace(bench(), lab=lab), "arm1", {PART: 1, DISC: 1})
    scene.hold(PART, 0)
    scene.open(34.0)
    joints = ik(ARM, 520, 420, 140, 0)[0]
    scene.arrange(stands(at={"post": (DISC, Pose(520 + 30 + 28 + 25, 420))}))
    _, hit = scene.look(joints)
    assert hit is not None and (hit.part, hit.obstacle) == ("held", "post")
    assert (hit.gap, hit.missing) == pytest.approx((28, 2), abs=0.05)
