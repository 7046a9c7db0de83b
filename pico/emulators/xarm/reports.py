"""What the control box tells unasked on its report ports: 30003 the pose, 30001 with faults, 30002 all of it.

Layout: support article "Data description of TCP port"; what it lacks of 30002 (from byte 517: joint range, fence,
rebound and reserved bytes) as the vendor's library reads it.
"""

from __future__ import annotations

import math
import struct

from pico.emulators.xarm.control_box import SLOWING, ControlBox
from pico.emulators.xarm.frames import packed

POSE, NORMAL, RICH = 30003, 30001, 30002
EVERY = {POSE: 0.01, NORMAL: 0.2, RICH: 0.2}
"""How often each tells [s]."""
_SIZES = {POSE: 135, NORMAL: 145, RICH: 587}


def report(port: int, box: ControlBox) -> bytes:
    """Return what `port` tells now, its own length first."""
    head = _head(box)
    if port == POSE:
        body = head + packed(*[0.0] * 12)
    elif port == NORMAL:
        body = head + _faults(box)
    else:
        body = head + _faults(box) + _rich(box)
    return struct.pack(">I", _SIZES[port]) + body.ljust(_SIZES[port] - 4, b"\0")


def _head(box: ControlBox) -> bytes:
    state = min(box.state, SLOWING)
    return (
        struct.pack(">BH", box.mode << 4 | state, len(box.queue))
        + packed(*box.joints, *box.pose(box.joints))
        + packed(*[0.0] * 7)
    )


def _faults(box: ControlBox) -> bytes:
    on = 0x7F if box.enabled else 0
    settings = box.settings
    return (
        bytes([on, on, box.error, box.warning])
        + packed(*settings.offset, *settings.load)
        + bytes([settings.sensitivity, settings.teaching])
        + packed(*settings.gravity)
    )


def _rich(box: ControlBox) -> bytes:
    settings, jerks = box.settings, box.settings.jerks
    servos = [v for joint in range(1, 8) for v in ((1, 1) if box.error == 10 + joint else (0, 0))]
    flags = settings.reduced | settings.fence << 1
    return b"".join(
        (
            bytes([box.model, box.axes, 0xAA, 0x55, 0, 0]),
            version_text(box).ljust(30, b"\0")[:30],
            packed(jerks[31], 1.0, jerks[32], 0.1, 1000.0),
            packed(jerks[33], 0.01, jerks[34], 1e-4, math.pi),
            packed(2.3, 2.7),
            bytes(servos) + bytes(2) + bytes([30] * 7),
            packed(*[0.0] * 8) + bytes(4) + packed(*[0.0] * 6),
            bytes([0, 0, 0, settings.self_collision, settings.tool_model]),
            packed(*settings.tool_size),
            struct.pack(">7H", *[4800] * 7) + packed(*[0.0] * 7),
            bytes(2 + 16 + 32) + packed(*[0.0] * 12) + bytes(1) + packed(*[0.0] * 3),
            bytes([flags, settings.reduced]),
            limits(box),
        )
    )


def limits(box: ControlBox) -> bytes:
    """Return boundary, speeds and joint range of the reduced mode, fence and rebound: as register 53 has them (p12)."""
    settings = box.settings
    return (
        struct.pack(">6h", *settings.boundary)
        + packed(settings.reduced_tool_speed, settings.reduced_joint_speed)
        + packed(*settings.joint_range)
        + bytes([settings.fence, settings.rebound])
    )


def version_text(box: ControlBox) -> bytes:
    """Return what register 1 tells: axes, model, arm and box by their serials' heads, and the firmware (p07)."""
    return f"{box.axes},{box.model},{box.serial[:6]},{box.box_serial[:6]},{box.firmware}".encode()
