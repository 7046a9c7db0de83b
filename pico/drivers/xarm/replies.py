"""What the control box may answer, byte by byte, where the vendor's library takes more than that for an answer.

The library fills up replies that are too short, takes the joints of before for those that are no numbers, and believes
whatever comes from the line of the gripper. Layouts: the vendor's "Private Modbus TCP" and Modbus RTU.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from typing import Any

STATE, FAULT, POSE, JOINTS, RTU = 13, 15, 41, 42, 124
_HEADER = 8
"""Bytes before the values: transaction, protocol and length (2 each), register, status."""
_SIZES = {STATE: 1, FAULT: 2, POSE: 24, JOINTS: 28}
"""How many bytes of values the answer of a register has."""
_STATES = range(1, 7)
"""In motion, ready, paused, stopped, reset, slowing down."""
_TURN = 2 * math.pi + 0.01
"""No joint turns further [rad]."""
_HOST, _READS, _GRIPPER = 9, 3, 8
_DAMAGED = 4
"""The library's code for an answer of a wrong length."""
_VALUES = (0, 1, 2)
"""Its codes for an answer with values: as asked, with a fault, with a warning."""
_POSITION, _STATUS = 0x0702, 0x0000
_BEYOND, _PULSES = 0.05, 850
"""How far beyond shut and open the gripper may count [of its whole way]; its whole way."""


def judged(commands: Any) -> None:
    """Have a connection of the library refuse damaged answers, as it refuses those of a wrong length."""
    port, send, receive = commands.arm_port, commands.send_modbus_request, commands.recv_modbus_response
    read: Callable[..., Any] = port.read
    asked, came = list[bytes](), list[bytes]()

    def sent(unit: int, data: Any, size: int, *more: Any, **named: Any) -> Any:
        asked[:] = [bytes(data[:size]) if size else b""]
        return send(unit, data, size, *more, **named)

    def heard(*timeout: Any, **named: Any) -> Any:
        found = read(*timeout, **named)
        came[:] = [] if found == -1 else [bytes(found)]
        return found

    def received(unit: int, *more: Any, **named: Any) -> Any:
        found = receive(unit, *more, **named)
        if found[0] in _VALUES and came and asked and not sound(unit, asked[0], came[0]):
            found[0] = _DAMAGED
        return found

    port.read, commands.send_modbus_request, commands.recv_modbus_response = heard, sent, received


def sound(register: int, asked: bytes, answer: bytes) -> bool:
    """Return whether an answer of a register has the form of one to what was `asked`: length, range, echo."""
    values = answer[_HEADER:]
    if len(answer) < _HEADER or len(answer) != 6 + int.from_bytes(answer[4:6], "big"):
        return False
    if register == RTU:
        return _of_gripper(asked, values)
    if len(values) != _SIZES.get(register, len(values)):
        return False
    if register == STATE:
        return values[0] in _STATES
    if register in (JOINTS, POSE):
        numbers = struct.unpack(f"<{len(values) // 4}f", values)
        return all(math.isfinite(v) and (register == POSE or abs(v) <= _TURN) for v in numbers)
    return True


def _of_gripper(asked: bytes, values: Sequence[int]) -> bool:
    """Whether the line's answer is that of the gripper to a request of a host, a slave, a function and its data."""
    if len(asked) < 7 or asked[1] != _GRIPPER:
        return True
    if list(values[:3]) != [_HOST, _GRIPPER, asked[2]]:
        return False
    if asked[2] != _READS:
        return bytes(values[3:7]) == asked[3:7]
    address, size = int.from_bytes(asked[3:5], "big"), 2 * int.from_bytes(asked[5:7], "big")
    data = bytes(values[4:])
    if values[3] != size or len(data) != size:
        return False
    if address == _POSITION:
        return -_BEYOND * _PULSES <= int.from_bytes(data, "big", signed=True) <= (1 + _BEYOND) * _PULSES
    return address != _STATUS or data[1] & 3 != 3
