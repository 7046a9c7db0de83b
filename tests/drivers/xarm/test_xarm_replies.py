"""Which answers of a control box are sound, where the vendor's library takes more for an answer."""

from __future__ import annotations

import math
import struct
from typing import Any

import pytest
from xarm_rig import Rig

from pico.diagnostics import PicoError
from pico.drivers.xarm.replies import FAULT, JOINTS, RTU, STATE, sound
from pico.emulators.xarm import server

READ_POSITION, READ_STATUS = bytes([9, 8, 3, 7, 2, 0, 2]), bytes([9, 8, 3, 0, 0, 0, 1])
WRITE_SPEED = bytes([9, 8, 16, 3, 3, 0, 1, 2, 5, 0xDC])


def answer(register: int, values: bytes, status: int = 0) -> bytes:
    return struct.pack(">HHHBB", 5, 3, 2 + len(values), register, status) + values


def joints(*angles: float) -> bytes:
    return struct.pack(f"<{len(angles)}f", *angles)


@pytest.mark.parametrize(
    ("register", "asked", "values"),
    [
        (STATE, b"", bytes([2])),
        (FAULT, b"", bytes([31, 0])),
        (JOINTS, b"", joints(*[0.5] * 7)),
        (RTU, READ_POSITION, bytes([9, 8, 3, 4]) + struct.pack(">i", 850)),
        (RTU, READ_STATUS, bytes([9, 8, 3, 2, 0, 2])),
        (RTU, WRITE_SPEED, bytes([9, 8, 16, 3, 3, 0, 1])),
    ],
)
def test_an_answer_as_the_manual_has_it_is_sound_and_one_of_another_length_is_not(
    register: int, asked: bytes, values: bytes
) -> None:
    good = answer(register, values)
    assert sound(register, asked, good) and sound(register, asked, answer(register, values, status=0x20))
    assert not sound(register, asked, good[:-1]) and not sound(register, asked, good + b"\0")
    assert not sound(register, asked, answer(register, values[:-1]))


@pytest.mark.parametrize(
    ("register", "asked", "values"),
    [
        (STATE, b"", bytes([0])),
        (STATE, b"", bytes([77])),
        (JOINTS, b"", joints(*[0.5] * 6, math.nan)),
        (JOINTS, b"", joints(*[0.5] * 6, math.inf)),
        (JOINTS, b"", joints(*[0.5] * 6, 6.4)),
        (RTU, READ_POSITION, bytes([9, 8, 3, 4]) + struct.pack(">i", 20_000)),
        (RTU, READ_POSITION, bytes([9, 7, 3, 4]) + struct.pack(">i", 850)),
        (RTU, READ_POSITION, bytes([9, 8, 0x83, 2, 0, 0, 0, 0])),
        (RTU, READ_POSITION, bytes([9, 8, 3, 2]) + struct.pack(">i", 850)),
        (RTU, READ_STATUS, bytes([9, 8, 3, 2, 0, 3])),
        (RTU, WRITE_SPEED, bytes([9, 8, 16, 3, 4, 0, 1])),
    ],
)
def test_what_no_control_box_or_gripper_answers_is_not_sound(register: int, asked: bytes, values: bytes) -> None:
    assert not sound(register, asked, answer(register, values))


def test_joints_that_are_no_numbers_are_told_as_lost_and_not_as_those_of_before(
    rig: Rig, monkeypatch: pytest.MonkeyPatch
) -> None:
    answered = server.answer

    def blank(box: Any, frame: Any) -> bytes:
        said = answered(box, frame)
        return said[:8] + joints(*[math.nan] * 7) if frame.register == JOINTS else said

    before = rig.do(rig.arm.state()).joints
    with monkeypatch.context() as patched:
        patched.setattr(server, "answer", blank)
        with pytest.raises(PicoError, match="no answer when it was asked where it is"):
            rig.do(rig.arm.state())
    assert rig.do(rig.arm.state()).joints == pytest.approx(before, abs=1e-5)
