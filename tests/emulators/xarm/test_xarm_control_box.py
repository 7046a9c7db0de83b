"""The control box by itself: what resets it, what stops it, what it can't know, at times that are told to it."""

from __future__ import annotations

import json
import math
import struct
from pathlib import Path

import numpy as np
import pytest

from pico.emulators.xarm import registers, reports
from pico.emulators.xarm.control_box import READY, ControlBox
from pico.emulators.xarm.frames import Frame, packed, split
from pico.emulators.xarm.kinematics import angles, rotation, tool_point, tool_pose

ZERO = (0.0,) * 7
INVALID, STUCK, FAULT = 0x08, 0x10, 0x40


def ready(mode: int = 0) -> ControlBox:
    box = ControlBox(ZERO)
    box.enabled, box.state, box.mode = True, READY, mode
    return box


def ask(box: ControlBox, register: int, payload: bytes = b"") -> tuple[int, bytes]:
    said = registers.answer(box, Frame(7, 3, register, payload))
    assert said[:4] == b"\0\7\0\3" and len(said) == 6 + int.from_bytes(said[4:6], "big") and said[6] == register
    return said[7], said[8:]


def test_where_its_tool_is_agrees_with_the_vendors_kinematics() -> None:
    assert np.allclose(tool_pose(ZERO), (206.0, 0.0, 120.5, math.pi, 0.0, 0.0), atol=1e-9)
    posture, offset = (0.3, -0.4, 0.2, 0.9, -0.1, 1.0, 0.7), (10.0, -20.0, 172.0, 0.1, -0.2, 0.3)
    assert np.allclose(tool_pose(posture, offset)[:3], tool_point(posture, offset))


@pytest.mark.parametrize("turn", [(0.1, -0.4, 2.0), (math.pi, 0.0, 0.3), (-1.0, 1.2, -2.5)])
def test_angles_about_fixed_axes_are_those_of_their_rotation(turn: tuple[float, float, float]) -> None:
    assert np.allclose(rotation(*angles(rotation(*turn))), rotation(*turn))


def test_a_register_that_there_is_not_is_invalid_and_noted() -> None:
    box = ready()
    assert ask(box, 99)[0] & INVALID and box.unknown == [99]
    assert ask(box, 37, b"\x09")[0] & INVALID and ask(box, 19, b"\x03\0")[0] & INVALID
    assert ask(box, 23, b"\0")[0] & INVALID, "a payload that is too short"
    assert box.unknown == [99] and box.requested[99] == 1


@pytest.mark.parametrize(
    ("register", "payload"),
    [(35, packed(0, 0, 100, 0, 0, 0)), (36, packed(1, 0, 0, 0)), (37, b"\x05"), (38, b"\x05"), (19, b"\x01\0"),
     (11, b"\x08\0")],
)  # fmt: skip
def test_what_changes_how_it_moves_ends_the_motion_and_asks_to_be_started_again(register: int, payload: bytes) -> None:
    box = ready()
    ask(box, 23, packed(0.5, 0, 0, 0, 0, 0, 0, 1.0, 5.0, 0))
    ask(box, 23, packed(0.8, 0, 0, 0, 0, 0, 0, 1.0, 5.0, 0))
    box.advance(0.1)
    status, _ = ask(box, register, payload)
    assert status & STUCK and box.state == 5 and not box.queue
    rest = box.joints
    box.advance(9.0)
    assert box.joints == rest
    assert ask(box, 29, packed(*[0.0] * 10))[0] & (STUCK | INVALID)


def test_set_points_after_a_changed_sensitivity_move_nothing_until_mode_and_state_are_set_again() -> None:
    box = ready(mode=1)
    ask(box, 37, b"\x04")
    for again in ((), ((19, b"\x01\0"),)):
        for register, payload in again:
            ask(box, register, payload)
        assert ask(box, 29, packed(0.01, *[0.0] * 9))[0] & (STUCK | INVALID)
        box.advance(box.now + 1.0)
        assert box.joints == ZERO
    ask(box, 12, b"\0")
    assert ask(box, 29, packed(0.01, *[0.0] * 9))[0] == 0
    box.advance(box.now + 1.0)
    assert box.joints[0] == pytest.approx(0.01)


def test_a_planned_move_takes_its_time_and_ends_where_it_was_sent() -> None:
    box = ready()
    assert ask(box, 23, packed(1.0, 0.2, 0, 0, 0, 0, 0, 0.5, 5.0, 0)) == (0, b"\0\1")
    passed = []
    for tick in range(300):
        box.advance(tick * 0.01)
        passed.append(box.joints[0])
    speeds = np.diff(passed) / 0.01
    assert passed[-1] == pytest.approx(1.0) and box.state == READY and box.finished == [(7, 0)]
    assert 0.49 < speeds.max() < 0.5001 and np.abs(np.diff(speeds)).max() <= 5.0 * 0.01 * 1.01
    assert box.joints[1] == pytest.approx(0.2)


def test_a_velocity_without_a_duration_never_ends_and_one_with_it_does() -> None:
    box = ready(mode=4)
    ask(box, 81, packed(0.1, *[0.0] * 6) + b"\1" + packed(0.3))
    box.advance(20.0)
    assert box.joints[0] == pytest.approx(0.03) and box.state == READY
    ask(box, 81, packed(0.1, *[0.0] * 6) + b"\1")
    box.advance(40.0)
    assert box.joints[0] == pytest.approx(0.03 + 2.0) and box.state == 1


def test_a_leap_of_set_points_is_a_fault_and_so_is_a_joint_beyond_its_range() -> None:
    box = ready(mode=1)
    ask(box, 29, packed(2.0, *[0.0] * 9))
    assert (box.error, box.state) == (24, 4)
    ask(box, 16)
    ask(box, 12, b"\0")
    box.joints = (0.0, 2.09, *[0.0] * 5)
    box.motion = None
    ask(box, 29, packed(0.0, 2.2, *[0.0] * 8))
    assert box.error == 23 and ask(box, 12, b"\0")[0] & FAULT


def test_an_emergency_stop_takes_the_power_and_comes_back_while_it_is_pressed() -> None:
    box = ready()
    box.pressed = 1
    box.fail(1)
    assert not box.enabled
    ask(box, 16)
    assert box.error == 1 and ask(box, 11, b"\x08\x01")[0] & FAULT and not box.enabled
    box.pressed = 0
    ask(box, 16)
    ask(box, 11, b"\x08\x01")
    ask(box, 12, b"\0")
    assert (box.error, box.enabled, box.state) == (0, True, READY)


def test_after_a_restart_what_was_not_saved_is_lost() -> None:
    box = ready()
    box.joints = (0.4, *ZERO[1:])
    ask(box, 37, b"\x05")
    ask(box, 40)
    ask(box, 36, packed(1, 0, 0, 0))
    again = box.restarted()
    assert again.joints == box.joints and not again.enabled and again.state == 4
    assert again.settings.sensitivity == 5 and again.settings.load == (0.0,) * 4


@pytest.mark.parametrize("port", [30001, 30002, 30003])
@pytest.mark.parametrize("state", [1, 2, 3, 4, 5, 6])
def test_reports_are_as_long_as_they_say_and_no_state_makes_the_library_drop_them(port: int, state: int) -> None:
    box = ready(mode=4)
    box.state = state
    said = reports.report(port, box)
    assert struct.unpack(">I", said[:4])[0] == len(said) == {30001: 145, 30002: 587, 30003: 135}[port]
    assert said[4] >> 4 == 4 and said[4] & 0x0F == state < 10
    assert struct.unpack("<7f", said[7:35]) == ZERO


def test_requests_that_come_in_pieces_or_together_are_told_apart() -> None:
    both = bytes.fromhex("0001 0002 0001 0D 0002 0002 0002 0C 04")
    for cut in range(len(both)):
        first, rest = split(both[:cut])
        second, rest = split(rest + both[cut:])
        assert [f.register for f in first + second] == [13, 12] and rest == b""


def test_the_side_channels_words_do_what_they_say() -> None:
    from pico.emulators.xarm.__main__ import channel
    from pico.emulators.xarm.server import XArmEmulator

    emulator = XArmEmulator(joints=ZERO)
    emulator.start()
    host = emulator.address["host"]
    words = channel(emulator)
    words["press"](0)
    assert emulator.box.error == 1
    words["release"](0)
    words["fault"](31)
    words["delay"](0.5)
    words["garbage"](0)
    assert emulator.box.error == 31 and [f.kind for f in emulator.faults] == ["delay", "garbage"]
    words["freeze"](0)
    words["thaw"](0)
    words["restart"](0)
    assert emulator.address["host"] == host and emulator.box.error == 0
    words["kill"](0)
    emulator.close()


def test_a_world_that_fails_is_told_where_the_emulator_is_closed() -> None:
    from pico.emulators.xarm.server import XArmEmulator

    def broken(joints: object, seconds: float) -> int:
        raise RuntimeError("the twin fell over")

    emulator = XArmEmulator(joints=ZERO, moved=broken)
    emulator.box.enabled, emulator.box.state = True, READY
    emulator.start()
    emulator.box.plan((1.0, *ZERO[1:]), 1.0, 5.0, 1)
    assert emulator._thread is not None
    emulator._thread.join(10.0)
    with pytest.raises(RuntimeError, match="fell over"):
        emulator.close()


def test_what_hits_something_stops_there() -> None:
    box = ready()
    box.moved = lambda joints, seconds: 31 if joints[0] > 0.2 else 0
    ask(box, 23, packed(1.0, 0, 0, 0, 0, 0, 0, 1.0, 5.0, 0))
    for tick in range(200):
        box.advance(tick * 0.01)
    assert box.error == 31 and 0.2 < box.joints[0] < 0.25


def test_its_tool_is_where_the_published_model_has_it() -> None:
    table = Path(__file__).resolve().parents[2] / "data" / "xarm7_forward_kinematics.json"
    half_a_turn = np.diag((-1.0, -1.0, 1.0))  # how the gripper of the table is mounted
    for sample in json.loads(table.read_text())["samples"]:
        x, y, z, *turn = tool_pose(sample["q"], (0, 0, 172.0, 0, 0, 0))
        assert np.allclose((x, y, z), sample["tcp"], atol=1e-3)
        assert np.allclose(rotation(*turn) @ half_a_turn, sample["R"], atol=1e-6)
