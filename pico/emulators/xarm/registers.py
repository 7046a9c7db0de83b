"""What each register does (pages p07 to p16): a function of the control box and the payload, to what is answered."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import replace

from pico.emulators.xarm import reports
from pico.emulators.xarm.control_box import (
    MOVING,
    ONLINE_JOINTS,
    PAUSED,
    POSITION,
    READY,
    SERVO,
    SLOWING,
    STOPPED,
    VELOCITY,
    ControlBox,
)
from pico.emulators.xarm.frames import Frame, floats, packed, reply
from pico.emulators.xarm.more_registers import MODES, MORE, Invalid, movable, queued
from pico.motion.xarm7 import LIMITS

_INVALID = 0x08
_TOOL_BUS, _BAUD_2M = 9, 11
_BAUD, _DIGITAL_IN = 0x0A0B, 0x0A14


def answer(box: ControlBox, frame: Frame) -> bytes:
    """Return the answer to one request; what is asked for happens at the box's own time."""
    box.requested[frame.register] += 1
    handler = REGISTERS.get(frame.register)
    try:
        if handler is None:
            box.unknown.append(frame.register)
            raise Invalid
        values = handler(box, frame)
    except (Invalid, struct.error, IndexError):
        box.invalid.append(frame.register)
        return reply(frame, box.status | _INVALID)
    return reply(frame, box.status, values)


def _version(box: ControlBox, frame: Frame) -> bytes:
    return reports.version_text(box).ljust(40, b"\0")


def _serials(box: ControlBox, frame: Frame) -> bytes:
    return (box.serial.encode() + b"\0" + box.box_serial.encode() + b"\n").ljust(40, b"\0")


def _enable(box: ControlBox, frame: Frame) -> bytes:
    if frame.payload[0] not in range(1, 9):
        raise Invalid
    on = bool(frame.payload[1])
    if on != box.enabled and not box.pressed:
        box.enabled = on
        box.reset()
    return b""


def _set_state(box: ControlBox, frame: Frame) -> bytes:
    wanted = frame.payload[0]
    if wanted == 0:
        if not box.error and box.enabled:
            box.state = MOVING if box.motion is not None or box.queue else READY
    elif wanted == PAUSED:
        box.state = PAUSED if box.state in (MOVING, READY) else box.state
    elif wanted == STOPPED:
        box.halt(STOPPED)
    elif wanted == SLOWING:
        if box.mode == POSITION and box.state == MOVING:
            box.halt(READY)
    else:
        raise Invalid
    return b""


def _errors(box: ControlBox, frame: Frame) -> bytes:
    return bytes([box.error, box.warning])


def _clear_error(box: ControlBox, frame: Frame) -> bytes:
    box.clear()
    return b""


def _clear_warning(box: ControlBox, frame: Frame) -> bytes:
    box.warning = 0
    return b""


def _set_mode(box: ControlBox, frame: Frame) -> bytes:
    if frame.payload[0] not in MODES:
        raise Invalid
    if frame.payload[0] != box.mode:
        box.reset()
        box.mode = frame.payload[0]
    return b""


def _move_joints(box: ControlBox, frame: Frame) -> bytes:
    *joints, speed, acceleration, _ = floats(frame.payload, 10)
    if movable(box, POSITION, ONLINE_JOINTS):
        if box.mode == ONLINE_JOINTS:
            box.replace_motion()
        box.plan(tuple(joints), speed, acceleration, frame.transaction)
    return queued(box)


def _servo(box: ControlBox, frame: Frame) -> bytes:
    if movable(box, SERVO):
        box.follow(floats(frame.payload, 7))
    return b""


def _drive(box: ControlBox, frame: Frame) -> bytes:
    speeds = floats(frame.payload, 7)
    duration = struct.unpack("<f", frame.payload[29:33])[0] if len(frame.payload) >= 33 else -1.0
    if movable(box, VELOCITY):
        box.drive(speeds, duration if duration > 0 else math.inf)
    return b""


def _limit_of_motion(box: ControlBox, frame: Frame) -> bytes:
    (box.settings.jerks[frame.register],) = floats(frame.payload, 1)
    return queued(box)


def _change(box: ControlBox, resets: bool, **values: object) -> bytes:
    """Set something; what changes how the arm moves is a system reset where it differs from what was set."""
    changed = any(getattr(box.settings, key) != value for key, value in values.items())
    box.settings = replace(box.settings, **values)  # type: ignore[arg-type]
    if changed and resets:
        box.reset()
    return b""


def _switch(key: str, resets: bool = False) -> Callable[[ControlBox, Frame], bytes]:
    return lambda box, frame: _change(box, resets, **{key: bool(frame.payload[0])})


def _vector(key: str, count: int, resets: bool = False) -> Callable[[ControlBox, Frame], bytes]:
    return lambda box, frame: _change(box, resets, **{key: floats(frame.payload, count)})


def _number(key: str) -> Callable[[ControlBox, Frame], bytes]:
    return lambda box, frame: _change(box, False, **{key: floats(frame.payload, 1)[0]})


def _level(key: str, least: int) -> Callable[[ControlBox, Frame], bytes]:
    def handler(box: ControlBox, frame: Frame) -> bytes:
        if not least <= frame.payload[0] <= 5:
            raise Invalid
        return _change(box, True, **{key: frame.payload[0]})

    return handler


def _boundary(box: ControlBox, frame: Frame) -> bytes:
    return _change(box, False, boundary=struct.unpack_from("<6i", frame.payload))


def _fence(box: ControlBox, frame: Frame) -> bytes:
    _change(box, False, fence=bool(frame.payload[0]))
    if box.settings.fence and box.outside(box.joints):
        box.fail(35)
    return b""


def _tool_model(box: ControlBox, frame: Frame) -> bytes:
    count, kind = divmod(len(frame.payload), 4)
    if kind != 1 or frame.payload[-1] not in (*range(6), 21, 22) or (frame.payload[-1] > 20) != bool(count):
        raise Invalid
    size = (floats(frame.payload, count) + (0.0,) * 6)[:6]
    return _change(box, False, tool_model=frame.payload[-1], tool_size=size)


def _save(box: ControlBox, frame: Frame) -> bytes:
    box.saved = deepcopy(box.settings)
    return b""


def _pose(box: ControlBox, frame: Frame) -> bytes:
    return packed(*box.pose(box.joints))


def _joints(box: ControlBox, frame: Frame) -> bytes:
    more = (frame.payload[0] & 0x0F) - 1 if frame.payload else 0
    return packed(*box.joints, *[0.0] * 7 * max(0, more))


def _forward(box: ControlBox, frame: Frame) -> bytes:
    return packed(*box.pose(floats(frame.payload, 7)))


def _beyond_joints(box: ControlBox, frame: Frame) -> bytes:
    angles = floats(frame.payload, 7)
    return bytes([any(not low <= a <= high for a, (low, high) in zip(angles, LIMITS, strict=True))])


def _limits(box: ControlBox, frame: Frame) -> bytes:
    return bytes([box.settings.reduced]) + reports.limits(box)


def _servo_states(box: ControlBox, frame: Frame) -> bytes:
    joints = [v for joint in range(1, 8) for v in ((1, 1) if box.error == 10 + joint else (0, 0))]
    return bytes([1 if any(joints) else 0, *joints, 0, 0])


def _tool_line(box: ControlBox, frame: Frame) -> bytes:
    """Register 124: Modbus to what is at the arm's end; the host's number is answered before what it says."""
    if frame.payload[0] != _TOOL_BUS or len(frame.payload) < 4:
        raise Invalid
    return bytes([_TOOL_BUS]) + box.claw.answer(frame.payload[1:])


def _read_tool(box: ControlBox, frame: Frame) -> bytes:
    host, address = struct.unpack_from(">BH", frame.payload)
    known = {_BAUD: _BAUD_2M, _DIGITAL_IN: 0}
    if host != _TOOL_BUS or address not in known:
        raise Invalid
    return struct.pack(">i", known[address])


def _finish_check(box: ControlBox, frame: Frame) -> bytes:
    box.finished.append((frame.transaction, 0))
    return b""


def _accepted(box: ControlBox, frame: Frame) -> bytes:
    return b""


REGISTERS: Mapping[int, Callable[[ControlBox, Frame], bytes]] = dict(MORE) | {
    1: _version,
    2: _serials,
    11: _enable,
    12: _set_state,
    13: lambda box, frame: bytes([box.state]),
    14: lambda box, frame: queued(box),
    15: _errors,
    16: _clear_error,
    17: _clear_warning,
    19: _set_mode,
    23: _move_joints,
    29: _servo,
    31: _limit_of_motion,
    32: _limit_of_motion,
    33: _limit_of_motion,
    34: _limit_of_motion,
    35: _vector("offset", 6, resets=True),
    36: _vector("load", 4, resets=True),
    37: _level("sensitivity", 0),
    38: _level("teaching", 1),
    40: _save,
    41: _pose,
    42: _joints,
    44: _forward,
    45: _beyond_joints,
    47: _number("reduced_tool_speed"),
    48: _number("reduced_joint_speed"),
    49: lambda box, frame: bytes([box.settings.reduced]),
    50: _switch("reduced"),
    51: _vector("gravity", 3),
    52: _boundary,
    53: _limits,
    58: _vector("joint_range", 14),
    59: _fence,
    60: _switch("rebound"),
    77: _switch("self_collision"),
    78: _tool_model,
    81: _drive,
    106: _servo_states,
    124: _tool_line,
    128: _read_tool,
    253: _finish_check,
    254: _accepted,
}
"""By number. 253 and 254 (tell when a task is over) and 124 stand on no page: as the vendor's library uses them."""
