"""Registers that PICO's driver does not use and other programs do: inverse kinematics, moves of the tool and by a
difference, the way home, the world frame, digital and analog inputs and outputs (pages p08 to p15).

Layouts are those that the vendor's library writes and reads. Moves in the frame of an axis and an angle, and the mere
check of a way, are answered as invalid.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping

from pico.emulators.xarm.control_box import MANUAL, ONLINE_JOINTS, ONLINE_LINE, POSITION, SERVO, ControlBox, Straight
from pico.emulators.xarm.frames import Frame, floats, packed
from pico.emulators.xarm.inverse import composed, inverse, turned
from pico.emulators.xarm.kinematics import rotation

MODES = (POSITION, SERVO, MANUAL, 4, ONLINE_JOINTS, ONLINE_LINE)
"""Modes that the emulated box has; it refuses 5, velocity of the tool."""
KINEMATICS = 21


class Invalid(Exception):
    """A register or a parameter that there is not: answered as invalid, and changes nothing."""


def movable(box: ControlBox, *modes: int) -> bool:
    """Return whether a motion is taken; raises Invalid in a mode that has other ones."""
    if box.mode not in modes:
        raise Invalid
    return not box.status & 0x50


def queued(box: ControlBox) -> bytes:
    return struct.pack(">H", len(box.queue))


def _inverse(box: ControlBox, frame: Frame) -> bytes:
    found = inverse(box.based(floats(frame.payload, 6)), box.joints, box.settings.offset)
    if found is None:
        raise Invalid
    return packed(*found)


def _pose_by_axis(box: ControlBox, frame: Frame) -> bytes:
    pose = box.pose(box.joints)
    return packed(*pose[:3], *turned(rotation(*pose[3:])))


def _beyond_tool(box: ControlBox, frame: Frame) -> bytes:
    return bytes([inverse(box.based(floats(frame.payload, 6)), box.joints, box.settings.offset) is None])


def _straight(box: ControlBox, pose: tuple[float, ...], speed: float, acceleration: float, frame: Frame) -> bytes:
    if movable(box, POSITION, ONLINE_LINE):
        if box.mode == ONLINE_LINE:
            box.replace_motion()
        box.plan_line(Straight(pose), speed, acceleration, frame.transaction)
    return queued(box)


def _move_line(box: ControlBox, frame: Frame) -> bytes:
    *pose, speed, acceleration, _ = floats(frame.payload, 9)
    tool_frame, axis_angle, check = frame.payload[40:43] if len(frame.payload) >= 43 else (0, 0, 0)
    if axis_angle or check:
        raise Invalid
    there = composed(box.planned_pose(), pose) if tool_frame else box.based(pose)
    return _straight(box, there, speed, acceleration, frame)


def _move_in_tool(box: ControlBox, frame: Frame) -> bytes:
    *pose, speed, acceleration, _ = floats(frame.payload, 9)
    if len(frame.payload) > 36 and frame.payload[36]:
        raise Invalid
    return _straight(box, composed(box.planned_pose(), pose), speed, acceleration, frame)


def _move_home(box: ControlBox, frame: Frame) -> bytes:
    speed, acceleration, _ = floats(frame.payload, 3)
    if len(frame.payload) > 12 and frame.payload[12]:
        raise Invalid
    if movable(box, POSITION):
        box.plan((0.0,) * 7, speed, acceleration, frame.transaction)
    return queued(box)


def _move_relative(box: ControlBox, frame: Frame) -> bytes:
    *by, speed, acceleration, _, _ = floats(frame.payload, 11)
    by = [v if math.isfinite(v) else 0.0 for v in by]  # the library sends infinity for what stays
    of_joints, axis_angle, *check = frame.payload[44:]
    if axis_angle or any(check[:1]):
        raise Invalid
    if not of_joints:
        goal = tuple(a + b for a, b in zip(box.planned_pose(), by[:6], strict=True))
        return _straight(box, goal, speed, acceleration, frame)
    if movable(box, POSITION, ONLINE_JOINTS):
        if box.mode == ONLINE_JOINTS:
            box.replace_motion()
        end = tuple(a + b for a, b in zip(box.planned_joints(), by, strict=True))
        box.plan(end, speed, acceleration, frame.transaction)
    return queued(box)


def _servo_line(box: ControlBox, frame: Frame) -> bytes:
    pose = box.based(floats(frame.payload, 6))
    if movable(box, SERVO):
        found = inverse(pose, box.joints, box.settings.offset)
        if found is None:
            box.fail(KINEMATICS)
        else:
            box.follow(found)
    return b""


def _world_offset(box: ControlBox, frame: Frame) -> bytes:
    box.settings.world = floats(frame.payload, 6)
    box.reset()
    return b""


def _digital_inputs(box: ControlBox, frame: Frame) -> bytes:
    return struct.pack(">H", box.inputs)


def _set_digital(box: ControlBox, frame: Frame) -> bytes:
    """Outputs 0 to 7 and 8 to 15: the high byte of each word names those that are set, the low byte to what."""
    words = struct.unpack_from(f">{min(2, len(frame.payload) // 2)}H", frame.payload)
    for place, word in enumerate(words):
        mask, value = (word >> 8) << 8 * place, (word & 0xFF) << 8 * place
        box.outputs = (box.outputs & ~mask) | (value & mask)
    return b""


def _analog_input(number: int) -> Callable[[ControlBox, Frame], bytes]:
    return lambda box, frame: struct.pack(">H", box.analog_inputs[number])


def _set_analog(number: int) -> Callable[[ControlBox, Frame], bytes]:
    def handler(box: ControlBox, frame: Frame) -> bytes:
        (value,) = struct.unpack_from(">H", frame.payload)
        if value > 4095:
            raise Invalid
        box.analog_outputs[number] = value
        return b""

    return handler


def _io_state(box: ControlBox, frame: Frame) -> bytes:
    low, high = (struct.pack(">HH", v & 0xFF, v & 0xFF) for v in (box.inputs, box.outputs))
    analog = struct.pack(">4H", *box.analog_inputs, *box.analog_outputs)
    return bytes(3) + low + high + analog + bytes(16)


MORE: Mapping[int, Callable[[ControlBox, Frame], bytes]] = {
    21: _move_line,
    25: _move_home,
    28: _move_in_tool,
    30: _servo_line,
    43: _inverse,
    46: _beyond_tool,
    73: _world_offset,
    83: _move_relative,
    91: _pose_by_axis,
    131: _digital_inputs,
    132: _analog_input(0),
    133: _analog_input(1),
    134: _set_digital,
    135: _set_analog(0),
    136: _set_analog(1),
    139: _io_state,
}
