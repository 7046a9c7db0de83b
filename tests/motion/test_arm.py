from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from oracles.inverse import ik
from outline import OUTLINE
from test_kinematics import SAMPLES

from pico.model.robot import Fingers, Gripper, Mount, Robot
from pico.motion.arm import FINGERS, attach_arm, build_arm
from pico.motion.hulls import of_shapes
from pico.motion.shapes import LINKS
from pico.motion.xarm7 import LIMITS

ROBOT = Robot(mount=Mount(x=480, y=760, z=12, yaw=-90))


@pytest.fixture(scope="module")
def model():
    return build_arm(ROBOT).compile()


def posed(model, joints, slide=0.0, name=""):
    data = mujoco.MjData(model)
    at = model.joint(f"{name}joint1").qposadr[0]
    data.qpos[at : at + 7] = joints
    data.qpos[at + 7 : at + 9] = slide
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    return data


def test_the_model_agrees_with_the_vendors_description(model):
    for joints, tcp, rotation in SAMPLES:
        site = posed(model, joints).site("tcp")
        assert site.xpos * 1000 == pytest.approx(tcp, abs=0.01)
        assert site.xmat == pytest.approx([v for row in rotation for v in row], abs=1e-6)


def test_joints_turn_as_far_as_the_real_ones(model):
    ranges = [tuple(model.joint(f"joint{i}").range) for i in range(1, 8)]
    assert ranges == [pytest.approx(limit) for limit in LIMITS]


def test_it_weighs_what_an_arm_weighs(model):
    assert 11.5 < model.body("base").subtreemass[0] < 14
    assert 0.7 < model.body("gripper").subtreemass[0] < 0.9


def test_the_opening_is_twice_the_slide_and_the_pads_reach_below_the_tool_center(model):
    data = posed(model, (0,) * 7, slide=0.02)
    tcp = data.site("tcp")
    for finger, side in zip(FINGERS, (1, -1), strict=True):
        center = tcp.xmat.reshape(3, 3).T @ (data.geom(f"{finger}_pad").xpos - tcp.xpos)
        half = model.geom(f"{finger}_pad").size
        assert side * center[1] - half[1] == pytest.approx(0.020)
        assert (2 * half[1], 2 * half[0]) == pytest.approx((0.014, 0.022))
        assert center[2] + half[2] == pytest.approx(0.010)


def test_two_arms_stand_at_their_mounts_under_their_names():
    spec = mujoco.MjSpec()
    attach_arm(spec, "left", ROBOT)
    attach_arm(spec, "right", Robot(mount=Mount(x=900, y=100, yaw=90)))
    model = spec.compile()
    data = posed(model, (0,) * 7, name="left/")
    assert data.body("left/base").xpos * 1000 == pytest.approx((480, 760, 12))
    # the outstretched tool is 206 mm before the base and 51.5 mm below it
    assert data.site("left/tcp").xpos * 1000 == pytest.approx((480, 554, -39.5))
    assert data.site("right/tcp").xpos * 1000 == pytest.approx((900, 306, -51.5))
    assert model.nu == 16


def test_parked_it_touches_nothing_of_itself(model):
    data = posed(model, [math.radians(q) for q in ROBOT.park], slide=0.042)
    assert data.ncon == 0


def test_reaching_into_its_own_shoulder_it_notices(model):
    joints = ik(Robot(mount=Mount(x=0, y=0)), 90, 0, 100, 90)[0]
    data = posed(model, joints)
    met = {model.body(model.geom_bodyid[g]).name for contact in data.contact for g in contact.geom}
    assert {"link1", "link7"} <= met


def test_the_jaws_press_with_28_newton_a_pad():
    spec = build_arm(ROBOT)
    spec.option.gravity = [0, 0, 0]
    block = spec.worldbody.add_body(name="block", pos=[0.206, 0, -0.0515])
    block.add_freejoint()
    block.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.015] * 3, mass=0.2, contype=2, conaffinity=1)
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model = spec.compile()
    data = mujoco.MjData(model)
    at = model.joint("left_slide").qposadr[0]
    data.qpos[at : at + 2] = 0.02
    for _ in range(400):
        mujoco.mj_step(model, data)
    wrench = np.zeros(6)
    forces = dict.fromkeys(FINGERS, 0.0)
    for i, contact in enumerate(data.contact):
        mujoco.mj_contactForce(model, data, i, wrench)
        bodies = {model.body(model.geom_bodyid[geom]).name for geom in contact.geom}
        for finger in FINGERS:
            forces[finger] += wrench[0] if f"{finger}_finger" in bodies else 0.0
    assert forces == {finger: pytest.approx(28, rel=0.1) for finger in FINGERS}


def test_a_vacuum_gripper_has_no_fingers():
    robot = Robot(mount=ROBOT.mount, gripper=Gripper(fingers="none"))
    model = build_arm(robot).compile()
    assert model.njnt == 7 and model.nu == 7


def test_fingers_have_the_size_that_the_lab_declares():
    robot = Robot(mount=ROBOT.mount, gripper=Gripper(fingers=Fingers(thickness=8, breadth=30), stroke=60))
    model = build_arm(robot).compile()
    assert model.geom("left_pad").size[:2] == pytest.approx((0.015, 0.004))
    assert model.joint("left_slide").range[1] == pytest.approx(0.030)


def test_the_shapes_that_collide_enclose_the_vendors_outline():
    """Of every link; 0.2 mm is what the figures are rounded and measured to."""
    for number, (points, shapes) in enumerate(zip(OUTLINE, LINKS, strict=True)):
        hulls = of_shapes(f"link{number}", shapes, 0.0)
        for point in points:
            out = min(outside(hull, np.array(point) / 1000) for hull in hulls) * 1000
            assert out < 0.2, (number, point, out)


def outside(hull, point):
    """How far a point is out of a hull [m], negative inside."""
    x, y, z = hull.turn.T @ (point - hull.center)
    r, _, h = hull.half
    if hull.kind == "capsule":
        return math.hypot(x, y, max(abs(z) - h, 0.0)) - r
    over = (math.hypot(x, y) - r, abs(z) - h) if hull.kind == "cylinder" else np.abs((x, y, z)) - np.array(hull.half)
    return max(over)
