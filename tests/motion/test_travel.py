"""Times without paths: what `move` takes where nothing is in the way."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import pytest
from benchtop import ARM, PART, bench, moved, stands
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from oracles.inverse import ik

from examples import examples
from pico.model.pose import Pose
from pico.model.robot import Gripper, Mount, Robot
from pico.motion import timing
from pico.motion.arms import ArmMotion
from pico.motion.timing import Limits
from pico.motion.types import MovePath

MOTION = ArmMotion(bench(), second_check=False)
places = st.builds(Pose, st.floats(150, 810), st.floats(150, 500), st.floats(-180, 180))
yaws = st.sampled_from([0, 90, -90, 35])


@given(st.floats(1e-4, 10), st.floats(0.1, 5), st.floats(0.1, 30), st.floats(1, 800))
@settings(max_examples=examples(200), deadline=None)
def test_the_closed_form_is_what_ruckig_finds(length, velocity, acceleration, jerk):
    limits = Limits(velocity, acceleration, jerk)
    assert timing.duration(length, limits) == pytest.approx(timing.profile(length, limits)[0][-1], rel=1e-6)


@given(places, places, st.sampled_from([0, 90]))
@settings(max_examples=examples(60), deadline=None)
def test_the_way_there_and_the_way_loaded_are_the_whole_move(start, goal, yaw):
    path = MOTION.move("arm1", "a", start, goal, yaw, {})
    assume(isinstance(path, MovePath))
    parts = MOTION.travel("arm1", None, start, 0, yaw) + MOTION.carry("arm1", "a", start, goal, yaw)
    assert path.seconds == pytest.approx(parts, rel=0.01)  # a turn that ends near a half one may take the other wrist


@given(places, places, places, places)
@settings(max_examples=40, deadline=None)
def test_a_move_after_another_takes_no_less_and_as_long_where_the_wrist_is_not_wound_up(a, b, c, d):
    first = MOTION.move("arm1", "a", a, b, 0, {})
    assume(isinstance(first, MovePath))
    second = MOTION.move("arm1", "a", c, d, 90, {}, first.end)
    assume(isinstance(second, MovePath))
    parts = MOTION.travel("arm1", b, c, 0, 90) + MOTION.carry("arm1", "a", c, d, 90)
    assert second.seconds > parts * 0.99
    if abs(first.end[6]) < math.pi / 2:
        assert second.seconds == pytest.approx(parts, rel=0.01)


@given(places, places, yaws, yaws)
@settings(max_examples=40, deadline=None)
def test_there_and_back_take_the_same(a, b, one, other):
    assert MOTION.travel("arm1", a, b, one, other) == pytest.approx(MOTION.travel("arm1", b, a, other, one), abs=1e-9)
    assert MOTION.travel("arm1", a, b, one, other) == pytest.approx(MOTION.travel("arm1", a, b, one + 180, other))


def test_staying_takes_no_time_and_out_of_reach_takes_forever():
    place = Pose(520, 420, 30)
    assert MOTION.travel("arm1", place, place) == 0
    assert MOTION.travel("arm1", None, None) == 0
    assert MOTION.travel("arm1", place, Pose(1100, 100)) == math.inf
    assert MOTION.carry("arm1", "a", place, Pose(1100, 100), 0) == math.inf


def test_an_arm_that_stands_low_rises_first_and_parks_at_the_end():
    low, place = ik(ARM, 620, 420, 100, 40)[0], Pose(300, 450)
    path = moved(MOTION.move("arm1", "a", place, Pose(400, 300), 0, stands(at={"a": (PART, place)}), low))
    assert MOTION.travel("arm1", low, place) == pytest.approx(path.segments[0].seconds, abs=0.003)
    home = moved(MOTION.park("arm1", low, {}))
    assert MOTION.travel("arm1", low, None) == pytest.approx(home.seconds, abs=0.003)


def test_a_gantry_and_a_vacuum_gripper_take_as_long_as_their_moves():
    robots = {
        "gantry": Robot(model="gantry", mount=Mount(x=0, y=0)),
        "cup": Robot(mount=ARM.mount, gripper=Gripper(fingers="none")),
    }
    motion = ArmMotion(bench(robots=robots), second_check=False)
    start, goal = Pose(290, 300, 10), Pose(620, 420, 40)
    for name in robots:
        path = moved(motion.move(name, "a", start, goal, 0, {}))
        parts = motion.travel(name, None, start) + motion.carry(name, "a", start, goal, 0)
        assert path.seconds == pytest.approx(parts, abs=0.003)
        home = moved(motion.park(name, path.end, {}))
        assert motion.travel(name, path.end, None) == pytest.approx(home.seconds, abs=0.003)


def test_asking_for_times_loads_neither_the_simulator_nor_numpy():
    code = (
        "import sys; sys.path.insert(0, 'tests/motion')\n"
        "from benchtop import bench\n"
        "from pico.model.pose import Pose\n"
        "from pico.motion.arms import ArmMotion\n"
        "motion = ArmMotion(bench())\n"
        "assert motion.travel('arm1', None, Pose(520, 420)) > 0.1\n"
        "assert motion.carry('arm1', 'a', Pose(520, 420), Pose(300, 300), 0) > 1\n"
        "print([m for m in ('mujoco', 'numpy', 'ruckig', 'fcl') if m in sys.modules])"
    )
    root = Path(__file__).parents[2]
    out = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True).stdout
    assert out.strip() == "[]"
