from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.inverse import ik

from examples import examples
from pico.model.robot import Mount, Robot
from pico.motion.kinematics import columns, fk
from pico.motion.paths import usable
from pico.motion.timing import Limits, jaw_seconds, profile, straight, vertical
from pico.motion.xarm7 import JOINT_ACCELERATION, JOINT_JERK, JOINT_SPEED, LIMITS

MOUNT = Mount(x=0, y=0)
places = st.tuples(st.floats(150, 660), st.floats(-3, 3), st.floats(-180, 180))


def derivatives(timed):
    """Greatest velocity, acceleration and jerk of any joint by finite differences; `timed` is evenly spaced."""
    times, joints = np.array(timed[0]), np.array(timed[1])
    step = times[1] - times[0]
    assert np.diff(times) == pytest.approx(step)
    return [float(np.abs(np.diff(joints, n, axis=0)).max(initial=0.0)) / step**n for n in (1, 2, 3)]


def tool_speed(timed):
    """Greatest speed of the tool center point between two waypoints [mm/s]."""
    points = np.array([fk(joints)[0] for joints in timed[1]])
    return float((np.linalg.norm(np.diff(points, axis=0), axis=1) / np.diff(timed[0])).max(initial=0.0))


def at(robot, place, z=250.0):
    radius, bearing, yaw = place
    return ik(robot, radius * np.cos(bearing), radius * np.sin(bearing), z, yaw)


@given(places, places, st.floats(0.1, 1.0))
@settings(max_examples=examples(60), deadline=None)
def test_swings_keep_the_joints_limits_and_stay_on_the_line(one, other, speed):
    robot = Robot(mount=MOUNT, speed=speed)
    start, end = at(robot, one)[0], at(robot, other)[0]
    timed = straight(robot, start, end)
    assert timed[1][0] == start and timed[1][-1] == pytest.approx(end, abs=1e-9)
    if len(timed[0]) < 5:
        return
    velocity, acceleration, jerk = derivatives(timed)
    assert velocity <= JOINT_SPEED * speed * 1.001
    assert acceleration <= JOINT_ACCELERATION * speed**2 * 1.001
    assert jerk <= JOINT_JERK * speed**3 * 1.001
    for joints in timed[1]:
        share = [(q - a) / (b - a) for q, a, b in zip(joints, start, end, strict=True) if abs(b - a) > 1e-6]
        assert max(share) - min(share) < 1e-6  # all joints in phase
        assert fk(joints)[1][2][2] == pytest.approx(-1, abs=1e-9)  # and the tool vertical


@given(places, st.floats(30, 140), st.floats(0.1, 1.0), st.booleans())
@settings(max_examples=examples(60), deadline=None)
def test_verticals_are_straight_and_keep_the_joints_limits(place, low, speed, down):
    robot = Robot(mount=MOUNT, speed=speed)
    radius, bearing, yaw = place
    for column in columns(robot, radius * np.cos(bearing), radius * np.sin(bearing), yaw):
        if not usable(column, low, 250.0):
            continue
        start, end = (250.0, low) if down else (low, 250.0)
        timed = vertical(robot, column, start, end)
        velocity, acceleration, jerk = derivatives(timed)
        assert velocity <= JOINT_SPEED * speed * 1.001
        assert acceleration <= JOINT_ACCELERATION * speed**2 * 1.01
        assert jerk <= JOINT_JERK * speed**3 * 1.05
        points = np.array([fk(joints)[0] for joints in timed[1]])
        assert points[:, :2] == pytest.approx(np.tile(points[0, :2], (len(points), 1)), abs=1e-6)
        assert points[0, 2] == pytest.approx(start) and points[-1, 2] == pytest.approx(end)


@given(places, places, st.floats(0.1, 1.0), st.sampled_from([1000.0, 250.0, 60.0]))
@settings(max_examples=examples(100), deadline=None)
def test_the_tool_is_never_faster_than_the_lab_allows(one, other, speed, allowed):
    robot = Robot(mount=MOUNT, speed=speed, tool_speed=allowed)
    for start in at(robot, one)[:2]:
        assert tool_speed(straight(robot, start, at(robot, other)[0])) <= allowed * 1.0001
    for column in columns(robot, one[0], 0, one[2]):
        if usable(column, 60, 250.0):
            assert tool_speed(vertical(robot, column, 60, 250)) <= allowed * 1.0001


@given(*[st.tuples(*(st.floats(low, high) for low, high in LIMITS))] * 2)
@settings(max_examples=examples(60), deadline=None)
def test_nor_where_it_goes_from_anyhow_to_anyhow(start, end):
    assert tool_speed(straight(Robot(mount=MOUNT, speed=1.0), start, end)) <= 1000.0


def test_a_long_swing_is_as_fast_as_the_tool_may_be():
    robot = Robot(mount=MOUNT, tool_speed=250.0)
    swing = straight(robot, at(robot, (400, -1, 0))[0], at(robot, (600, 1, 90))[0])
    assert 245 < tool_speed(swing) <= 250


def test_half_the_speed_takes_twice_as_long():
    fast, slow = Robot(mount=MOUNT, speed=1.0), Robot(mount=MOUNT, speed=0.5, tool_speed=500.0)
    start, end = at(fast, (400, 0, 0))[0], at(fast, (500, 1, 90))[0]
    assert straight(slow, start, end)[0][-1] == pytest.approx(2 * straight(fast, start, end)[0][-1])
    column = columns(fast, 450, 0, 0)[0]
    assert vertical(slow, column, 100, 250)[0][-1] == pytest.approx(2 * vertical(fast, column, 100, 250)[0][-1])


def test_a_long_way_takes_the_time_of_the_textbook():
    # seven phases: t = s/v + v/a + a/j where velocity and acceleration reach their limits
    times, ways = profile(100.0, Limits(10.0, 5.0, 5.0))
    assert times[-1] == pytest.approx(100 / 10 + 10 / 5 + 5 / 5)
    assert (ways[0], ways[-1]) == (0.0, 100.0)


def test_a_grip_takes_the_way_of_the_jaws_and_the_time_to_set():
    assert jaw_seconds(84.0, 34.0) == jaw_seconds(34.0, 84.0) == pytest.approx(0.5 + 0.2)
    assert jaw_seconds(34.0, 34.0) == pytest.approx(0.2)


def test_no_way_takes_no_time():
    robot = Robot(mount=MOUNT)
    joints = at(robot, (400, 0, 0))[0]
    assert straight(robot, joints, joints) == ((0.0,), (joints,))
