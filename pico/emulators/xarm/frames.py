"""Frames of the vendor's protocol (page p05): a header in big-endian order, floats in little-endian order."""

from __future__ import annotations

import struct
from dataclasses import dataclass

_HEADER = struct.Struct(">HHHB")


@dataclass(frozen=True, slots=True)
class Frame:
    """A request: transaction, protocol (2, or 3 where heartbeats are due), register and what follows it."""

    transaction: int
    protocol: int
    register: int
    payload: bytes = b""


def split(buffer: bytes) -> tuple[list[Frame], bytes]:
    """Return the whole requests at the head of `buffer`, and what is left of it."""
    found = []
    while len(buffer) >= 6 and len(buffer) >= (end := 6 + int.from_bytes(buffer[4:6], "big")) and end > 6:
        transaction, protocol, _, register = _HEADER.unpack_from(buffer)
        found.append(Frame(transaction, protocol, register, buffer[_HEADER.size : end]))
        buffer = buffer[end:]
    return found, buffer


def reply(to: Frame, status: int, values: bytes = b"") -> bytes:
    """Return the answer to a request, with its status byte and what follows it."""
    return _HEADER.pack(to.transaction, to.protocol, 2 + len(values), to.register) + bytes([status]) + values


def finished(transaction: int, protocol: int, kind: int) -> bytes:
    """Return the frame that says, unasked, that the task of `transaction` is over; `kind` is a bit of register 254.

    No page describes it: the layout is what the vendor's library reads, with zeros where it reads nothing.
    """
    return _HEADER.pack(transaction, protocol, 7, 0xFF) + bytes([0, kind, 0, 0, 0, 0])


def packed(*values: float) -> bytes:
    """Return floats as they are sent."""
    return struct.pack(f"<{len(values)}f", *values)


def floats(payload: bytes, count: int) -> tuple[float, ...]:
    """Return the first `count` floats of a payload. Raises struct.error where it is shorter."""
    return struct.unpack_from(f"<{count}f", payload)
