from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.inverse import ik

from pico.model.robot import Mount, Robot
from pico.motion.kinematics import column_of, columns, fk, reaches, span, tool_pose
from pico.motion.xarm7 import LIMITS

DATA = json.loads((Path(__file__).parents[1] / "data" / "xarm7_forward_kinematics.json").read_text())
SAMPLES = [(tuple(s["q"]), s["tcp"], s["R"]) for s in DATA["samples"]]

mounts = st.builds(
    Mount, x=st.floats(-500, 1500), y=st.floats(-500, 1500), z=st.floats(-50, 200), yaw=st.floats(-180, 180)
)
postures = st.tuples(*(st.floats(low, high) for low, high in LIMITS))


@pytest.mark.parametrize(("joints", "tcp", "rotation"), SAMPLES)
def test_forward_kinematics_agrees_with_the_vendors_description(joints, tcp, rotation):
    position, turned = fk(joints)
    assert position == pytest.approx(tcp, abs=0.01)
    assert [v for row in turned for v in row] == pytest.approx([v for row in rotation for v in row], abs=1e-6)


def within_limits(joints):
    return all(low <= q <= high for q, (low, high) in zip(joints, LIMITS, strict=True))


@given(
    mount=mounts,
    radius=st.floats(100, 700),
    bearing=st.floats(-math.pi, math.pi),
    z=st.floats(40, 350),
    yaw=st.floats(-360, 360),
)
def test_every_inverse_solution_is_within_limits_and_leads_back(mount, radius, bearing, z, yaw):
    robot = Robot(mount=mount)
    x, y = mount.x + radius * math.cos(bearing), mount.y + radius * math.sin(bearing)
    for joints in ik(robot, x, y, z, yaw):
        assert within_limits(joints)
        back = tool_pose(robot, joints)
        assert back[:3] == pytest.approx((x, y, z), abs=1e-6)
        assert math.remainder(back[3] - yaw, 360) == pytest.approx(0, abs=1e-6)
        assert fk(joints)[1][2][2] == pytest.approx(-1)  # the tool points straight down


@given(mount=mounts, q1=st.floats(*LIMITS[0]), q2=st.floats(*LIMITS[1]), q4=st.floats(*LIMITS[3]), q7=st.floats(-6, 6))
def test_inverse_kinematics_finds_every_posture_with_a_vertical_tool(mount, q1, q2, q4, q7):
    joints = (q1, q2, 0.0, q4, 0.0, q4 - q2, q7)
    robot = Robot(mount=mount)
    # outstretched, and straight over the base, two postures are one: there the inverse loses half of its digits
    (x, y, _), _ = fk(joints)
    elbow = math.remainder(q4 - math.atan2(77.5, 342.5) - math.atan2(52.5, 293), 2 * math.pi)
    if not within_limits(joints) or min(abs(elbow), math.pi - abs(elbow)) < 1e-3 or math.hypot(x, y) < 1e-3:
        return
    near = [s for s in ik(robot, *tool_pose(robot, joints)) if max(map(abs, _difference(s, joints))) < 1e-4]
    edge = any(min(q - low, high - q) < 1e-4 for q, (low, high) in zip(joints, LIMITS, strict=True))
    assert near or edge
    column = column_of(robot, joints)
    assert column is not None
    assert column.at(tool_pose(robot, joints)[2]) == pytest.approx(joints, abs=1e-4) or edge


def _difference(a, b):
    return [u - v for u, v in zip(a, b, strict=True)]


@given(postures)
def test_a_tilted_tool_stands_on_no_column(joints):
    robot = Robot(mount=Mount(x=0, y=0))
    tilt = fk(joints)[1][2][2]
    if tilt > -0.99:
        assert column_of(robot, joints) is None


def test_a_column_holds_the_tool_at_one_place_while_it_rises():
    robot = Robot(mount=Mount(x=480, y=760, yaw=-90))
    for column in columns(robot, 520, 420, 30):
        for z in (100, 173, 250):
            if joints := column.at(z):
                assert tool_pose(robot, joints) == pytest.approx((520, 420, z, 30), abs=1e-6)


def test_the_reach_of_the_arm_is_what_was_measured_for_the_real_one():
    robot = Robot(mount=Mount(x=0, y=0))
    # research on the vendor's model: 0.72 m at 5 cm height, 0.67 m at 25 cm, 0.585 m at 40 cm
    assert [span(robot, z)[1] for z in (50, 250, 400)] == pytest.approx([720, 670, 585], abs=5)


@given(z=st.floats(30, 380), radius=st.floats(0, 800), bearing=st.floats(-3, 3))
def test_reaching_is_having_a_solution(z, radius, bearing):
    robot = Robot(mount=Mount(x=100, y=-30, yaw=40))
    x, y = 100 + radius * math.cos(bearing), -30 + radius * math.sin(bearing)
    assert reaches(robot, x, y, z) == bool(ik(robot, x, y, z, 17.0))
