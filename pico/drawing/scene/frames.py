"""Where things are at one moment, as few bytes (little endian), for who draws a bench live.

u8 version, u32 epoch, u32 rev, f64 time [s]; u8 arms, each u8 index, u8 n, n x f32 joints [rad; of a gantry m and rad],
f32 distance between the pads [mm]; u16 bodies, each u16 index, 3 x f32 position [mm], 4 x f32 quaternion (w, x, y, z).
A frame says where what is in it is now; of what is not in it nothing has changed. Each stands for itself.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass, field

VERSION = 1
_HEAD, _ARM, _BODY = struct.Struct("<BIIdB"), struct.Struct("<BB"), struct.Struct("<H7f")
_COUNT, _FLOAT = struct.Struct("<H"), struct.Struct("<f")
Body = tuple[float, float, float, float, float, float, float]
"""Position [mm] and quaternion (w, x, y, z)."""
Arm = tuple[tuple[float, ...], float]
"""Joints, and the distance between the pads [mm]."""


@dataclass(frozen=True, slots=True)
class Frame:
    """Arms and bodies by their index in the scene of an `epoch`, at `rev` of it and a `time` of the bench [s]."""

    epoch: int
    rev: int
    time: float
    arms: Mapping[int, Arm] = field(default_factory=dict)
    bodies: Mapping[int, Body] = field(default_factory=dict)


def encoded(frame: Frame) -> bytes:
    """Return a frame as bytes; raises struct.error for an index or a count that has no room."""
    parts = [_HEAD.pack(VERSION, frame.epoch, frame.rev, frame.time, len(frame.arms))]
    for index, (joints, width) in frame.arms.items():
        parts += [_ARM.pack(index, len(joints)), struct.pack(f"<{len(joints) + 1}f", *joints, width)]
    parts.append(_COUNT.pack(len(frame.bodies)))
    parts += [_BODY.pack(index, *body) for index, body in frame.bodies.items()]
    return b"".join(parts)


def decoded(data: bytes) -> Frame:
    """Return the frame that bytes are; raises ValueError for what is none."""
    try:
        version, epoch, rev, time, count = _HEAD.unpack_from(data)
        at, arms, bodies = _HEAD.size, dict[int, Arm](), dict[int, Body]()
        for _ in range(count):
            index, n = _ARM.unpack_from(data, at)
            *joints, width = struct.unpack_from(f"<{n + 1}f", data, at + _ARM.size)
            arms[index] = (tuple(joints), width)
            at += _ARM.size + (n + 1) * _FLOAT.size
        (count,) = _COUNT.unpack_from(data, at)
        at += _COUNT.size
        for _ in range(count):
            index, x, y, z, *turned = _BODY.unpack_from(data, at)
            w, i, j, k = turned
            bodies[index] = (x, y, z, w, i, j, k)
            at += _BODY.size
    except struct.error as exc:
        raise ValueError(f"this is no frame: {exc}") from exc
    if version != VERSION or at != len(data):
        raise ValueError(f"this is no frame of version {VERSION}")
    return Frame(epoch, rev, time, arms, bodies)
