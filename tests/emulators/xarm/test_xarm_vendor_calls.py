"""Calls of the vendor's library against the emulated arm: which it answers as the box does, and which it refuses."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from typing import Any

import numpy as np
import pytest

from pico.emulators.xarm.control_box import READY, ControlBox
from pico.emulators.xarm.inverse import about, inverse, line, turned
from pico.emulators.xarm.kinematics import rotation, tool_pose
from pico.emulators.xarm.server import XArmEmulator

HOME = (0.0, -0.5, 0.0, 0.5, 0.0, 1.0, 0.0)
NONE = (0.0,) * 6
OFFSET = (0.0, 0.0, 172.0, 0.0, 0.0, 0.0)

REFUSED = {"circle", "force sensor", "mode 5", "sleep", "suction", "torques"}
ANSWERED = 48
"""Of the calls below."""
STATE_NOT_READY = 9
"""Of the calls below; of the same list the emulator answered 25 before it knew more than PICO's driver needs."""


@pytest.mark.parametrize("shift", [(20, 10, -30, 0, 0, 0), (0, 0, 0, 0.1, -0.2, 0.3), (-60, 40, 50, 0.2, 0.1, -0.5)])
def test_inverse_kinematics_find_joints_that_forward_kinematics_put_at_the_pose(shift: tuple[float, ...]) -> None:
    pose = tuple(a + b for a, b in zip(tool_pose(HOME, OFFSET), shift, strict=True))
    joints = inverse(pose, HOME, OFFSET)
    assert joints is not None
    there = tool_pose(joints, OFFSET)
    assert np.allclose(there[:3], pose[:3], atol=1e-2)
    assert np.allclose(rotation(*there[3:]), rotation(*pose[3:]), atol=1e-4)


@pytest.mark.parametrize("vector", [(0.0, 0.0, 0.0), (0.3, -0.2, 1.0), (math.pi, 0.0, 0.0), (2.2, -2.2, 0.2)])
def test_a_rotation_is_an_axis_times_an_angle_also_close_to_half_a_turn(vector: tuple[float, ...]) -> None:
    size = float(np.linalg.norm(vector))
    axis = np.array(vector) / (size or 1.0)
    assert np.allclose(turned(about(axis, size)), vector, atol=1e-6)


def test_what_is_out_of_reach_has_no_joints() -> None:
    assert inverse((2000, 0, 200, math.pi, 0, 0), HOME, NONE) is None


def test_the_tool_goes_straight() -> None:
    begin = tool_pose(HOME, OFFSET)
    end = (begin[0] + 60, begin[1] + 40, begin[2] - 50, *begin[3:])
    way = line(HOME, end, OFFSET, 100.0, 1000.0, 0.0)
    assert way is not None
    along = (np.array(end) - np.array(begin))[:3]
    for share in np.linspace(0, 1, 23):
        off = np.array(tool_pose(way.at(share * way.ride.seconds), OFFSET)[:3]) - np.array(begin[:3])
        assert np.linalg.norm(np.cross(off, along)) / np.linalg.norm(along) < 0.05
    assert np.allclose(tool_pose(way.at(99.0), OFFSET)[:3], end[:3], atol=1e-2)


def test_a_line_out_of_reach_is_a_fault_of_kinematics() -> None:
    from pico.emulators.xarm.control_box import Straight

    box = ControlBox(HOME)
    box.enabled, box.state = True, READY
    box.plan_line(Straight((2000, 0, 200, math.pi, 0, 0)), 100, 1000, 1)
    box.advance(0.1)
    assert box.error == 21 and box.joints == HOME


Call = Callable[[Any], Any]
POSE = (300.0, 0.0, 250.0, math.pi, 0.0, 0.0)
CALLS: dict[str, Call] = {
    "version": lambda a: a.get_version(),
    "serial": lambda a: a.get_robot_sn(),
    "state": lambda a: a.get_state(),
    "errors": lambda a: a.get_err_warn_code(),
    "queue": lambda a: a.get_cmdnum(),
    "joints": lambda a: a.get_servo_angle(is_radian=True),
    "position": lambda a: a.get_position(is_radian=True),
    "position by axis and angle": lambda a: a.get_position_aa(is_radian=True),
    "forward kinematics": lambda a: a.get_forward_kinematics(list(HOME), True, True),
    "inverse kinematics": lambda a: a.get_inverse_kinematics(list(a.get_position(is_radian=True)[1]), True, True),
    "joint limit": lambda a: a.is_joint_limit(list(HOME), True),
    "tool limit": lambda a: a.is_tcp_limit(list(POSE), True),
    "reduced mode": lambda a: a.get_reduced_mode(),
    "reduced states": lambda a: a.get_reduced_states(),
    "torques": lambda a: a.get_joints_torque(),
    "motors": lambda a: a.get_servo_debug_msg(),
    "clean error": lambda a: a.clean_error(),
    "clean warning": lambda a: a.clean_warn(),
    "enable": lambda a: a.motion_enable(True),
    "joint jerk": lambda a: a.set_joint_jerk(20, is_radian=True),
    "tool jerk": lambda a: a.set_tcp_jerk(1000),
    "joint acceleration": lambda a: a.set_joint_maxacc(10, is_radian=True),
    "tool acceleration": lambda a: a.set_tcp_maxacc(1000),
    "tool offset": lambda a: a.set_tcp_offset([0, 0, 172, 0, 0, 0]),
    "tool load": lambda a: a.set_tcp_load(0.8, [0, 0, 60]),
    "sensitivity": lambda a: a.set_collision_sensitivity(3),
    "teaching": lambda a: a.set_teach_sensitivity(3),
    "gravity": lambda a: a.set_gravity_direction([0, 0, -1]),
    "rebound": lambda a: a.set_collision_rebound(False),
    "self-collision": lambda a: a.set_self_collision_detection(True),
    "fence": lambda a: a.set_fense_mode(False),
    "save": lambda a: a.save_conf(),
    "mode 2": lambda a: a.set_mode(2),
    "mode 4": lambda a: a.set_mode(4),
    "mode 5": lambda a: a.set_mode(5),
    "mode 6": lambda a: a.set_mode(6),
    "mode 7": lambda a: a.set_mode(7),
    "mode 0": lambda a: (a.set_mode(0), a.set_state(0))[1],
    "move joints": lambda a: a.set_servo_angle(angle=list(HOME), is_radian=True, wait=False),
    "move home": lambda a: a.move_gohome(wait=False),
    "move line": lambda a: a.set_position(z=10, relative=True, wait=False),
    "move in the tool's frame": lambda a: a.set_tool_position(z=-5, wait=False),
    "move joints by": lambda a: a.set_servo_angle(servo_id=7, angle=0.1, relative=True, is_radian=True, wait=False),
    "sleep": lambda a: a.set_pause_time(0.1),
    "world offset": lambda a: a.set_world_offset([0, 0, 0, 0, 0, 0]),
    "digital inputs": lambda a: a.get_cgpio_digital(),
    "analog inputs": lambda a: a.get_cgpio_analog(),
    "set digital output": lambda a: a.set_cgpio_digital(3, 1),
    "set analog output": lambda a: a.set_cgpio_analog(0, 2.5),
    "inputs and outputs": lambda a: a.get_cgpio_state(),
    "tool's digital inputs": lambda a: a.get_tgpio_digital(),
    "suction": lambda a: a.set_vacuum_gripper(True, wait=False),
    "force sensor": lambda a: a.get_ft_sensor_data(),
    "circle": lambda a: a.move_circle(list(POSE), list(POSE), 50, wait=False),
}


@pytest.fixture
def arm() -> Iterator[Any]:
    if not find_spec("xarm"):
        pytest.skip("the extra xarm")
    from pico.drivers.xarm.library import connected, dropped

    emulator = XArmEmulator(joints=HOME, pace=20.0)
    emulator.start()
    made = connected(str(emulator.address["host"]), int(emulator.address["port"]))
    made.motion_enable(True)
    made.set_mode(0)
    made.set_state(0)
    yield made, emulator
    dropped(made)
    emulator.close()


def code(answer: Any) -> int:
    return int(answer[0] if isinstance(answer, tuple | list) else answer)


def test_so_many_calls_of_the_vendors_library_are_answered(arm: tuple[Any, XArmEmulator]) -> None:
    made, emulator = arm
    refused = set()
    for name, call in CALLS.items():
        before = len(emulator.box.invalid)
        try:
            answered = code(call(made)) in (0, STATE_NOT_READY)
        except ValueError:  # the library can't read an answer of nothing
            answered = False
        if not answered or len(emulator.box.invalid) > before:
            refused.add(name)
    assert refused == REFUSED
    assert (len(CALLS), len(CALLS) - len(refused)) == (54, ANSWERED)


def test_moves_of_the_library_end_where_they_are_to(arm: tuple[Any, XArmEmulator]) -> None:
    made, emulator = arm
    begin = made.get_position(is_radian=True)[1]
    assert made.set_position(x=30, z=20, relative=True, speed=200, wait=False, is_radian=True) == 0
    at_rest(emulator)
    end = made.get_position(is_radian=True)[1]
    assert np.allclose(np.subtract(end, begin)[:3], (30, 0, 20), atol=0.05)
    assert made.set_servo_angle(servo_id=7, angle=0.2, relative=True, is_radian=True, speed=1.0, wait=False) == 0
    at_rest(emulator)
    assert made.move_gohome(speed=1.0, is_radian=True, wait=False) == 0
    at_rest(emulator)
    assert np.allclose(emulator.joints, 0.0, atol=1e-6)


def at_rest(emulator: XArmEmulator) -> None:
    until = time.monotonic() + 5
    while time.monotonic() < until:
        with emulator.lock:
            if not emulator.box.queue and emulator.box.motion is None:
                return
        time.sleep(0.01)


def test_outputs_are_set_and_the_world_frame_moves_what_is_told(arm: tuple[Any, XArmEmulator]) -> None:
    made, emulator = arm
    assert made.set_cgpio_digital(3, 1) == 0 and made.set_cgpio_digital(9, 1) == 0
    assert emulator.box.outputs == 1 << 3 | 1 << 9
    assert made.set_cgpio_digital(3, 0) == 0 and emulator.box.outputs == 1 << 9
    emulator.box.analog_inputs[0] = 2048
    assert made.get_cgpio_analog(0)[1] == pytest.approx(5.0, abs=0.01)
    before = made.get_position(is_radian=True)[1]
    assert made.set_world_offset([100, 0, 50, 0, 0, 0], is_radian=True) == 0
    after = made.get_position(is_radian=True)[1]
    assert np.allclose(np.subtract(after, before)[:3], (100, 0, 50), atol=0.01)
