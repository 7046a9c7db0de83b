from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.inverse import ik

from examples import examples
from pico.model.lab import Mount, Robot
from pico.motion.kinematics import columns, fk
from pico.motion.paths import usable
from pico.motion.timing import Limits, jaw_seconds, profile, straight, vertical
from pico.motion.xarm7 import JOINT_ACCELERATION, JOINT_JERK, JOINT_SPEED, TOOL_SPEED

MOUNT = Mount(x=0, y=0)
places = st.tuples(st.floats(150, 660), st.floats(-3, 3), st.floats(-180, 180))


def derivatives(timed):
    """Greatest velocity, acceleration and jerk of any joint by finite differences; `timed` is evenly spaced."""
    times, joints = np.array(timed[0]), np.array(timed[1])
    step = times[1] - times[0]
    assert np.diff(times) == pytest.approx(step)
    return [float(np.abs(np.diff(joints, n, axis=0)).max(initial=0.0)) / step**n for n in (1, 2, 3)]


def at(robot, place, z=250.0):
    radius, bearing, yaw = place
    return ik(robot, radius * np.cos(bearing), radius * np.sin(bearing), z, yaw)


@given(places, places, st.floats(0.1, 1.0))
@settings(max_examples=examples(60), deadline=None)
def test_swings_keep_the_joints_limits_and_stay_on_the_line(one, other, speed):
    robot = Robot(mount=MOUNT, speed=speed)
    start, end = at(robot, one)[0], at(robot, other)[0]
    timed = straight(robot, start, end)
    assert timed[1][0] == start and timed[1][-1] == pytest.approx(end)
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
        assert np.abs(np.diff(points[:, 2])).max() / timed[0][1] <= TOOL_SPEED * speed * 1.001


def test_half_the_speed_takes_twice_as_long():
    fast, slow = Robot(mount=MOUNT, speed=1.0), Robot(mount=MOUNT, speed=0.5)
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
