"""The control box of an xArm and its gripper for `benchmarks/wire_replies.py`: how its answers and reports are
replaced, and what they mean by the vendor's manuals, read byte by byte and apart from driver and library.

An answer of the control port ("Private Modbus TCP", big-endian): transaction (2 bytes), protocol 2, length of what
follows (2), register (1), status (1: bit 3 invalid, 4 not ready, 5 warning, 6 fault), values. Register 13: the state,
15: fault and warning, 42: seven joints as little-endian floats [rad]. Register 124 carries Modbus RTU of the gripper:
host 9, slave 8, function 3, count of bytes, values. A report of port 30002: its length (4), mode and state (1), queue
(2), joints, pose, torques (20 floats), brakes, enabled motors, fault, warning (a byte each), the rest; 587 bytes.
"""

from __future__ import annotations

import asyncio
import math
import random
import struct
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from wire_grammars import NOTHING, Allowed

from pico.emulators.behind import Alone
from pico.emulators.registry import emulator
from pico.emulators.xarm import server
from pico.emulators.xarm.server import XArmEmulator
from pico.model.wiring import DeviceEntry

STATE, FAULT, JOINTS, RTU, ENABLED = 13, 15, 42, 124, 88
PACE = 10.0
PULSES = 850
HOLDS = 0.55
"""For so long at most no report follows one that was replaced, until it was judged [s]; PICO takes 0.6 for lost."""
RANGE = 2 * math.pi + 0.01
"""No joint of an xArm7 turns further [rad]."""
ARM = DeviceEntry(
    driver="xarm.arm", emulator="xarm", address={"host": ""}, identity={"serial": "XI130500123456"},
    settings={"pace": PACE},
)  # fmt: skip
GRIPPER = DeviceEntry(
    driver="xarm.gripper", emulator="xarm", address={"host": ""}, identity={"serial": "XI130500123456"}
)


def asks(register: int, modbus: bytes = b"") -> Callable[[bytes], bool]:
    """Return whether a request is for a register, and of the gripper for one of its own."""
    return lambda asked: asked[0] == register and modbus in asked[1:]


class Behind(Alone):
    """What is behind the emulated box is the box itself."""

    def write(self, what: str, value: Any) -> None:
        made = self.read("emulator")
        if made is None or what in ("emulator", "faults"):
            super().write(what, value)
            return
        with made.lock:
            box, claw = made.box, made.box.claw
            if what == "joints":
                box.joints = value
            elif what == "fault":
                box.error = value
            elif what == "state":
                box.state = value
            elif what == "pulses":
                claw.pulses = claw.ends = claw.target = float(value)
            elif what == "claw fault":
                claw.error = value


@contextmanager
def wire(case: Any, forger: Any) -> Iterator[tuple[DeviceEntry, Alone]]:
    """Yield the entry of an emulated box and what is behind it, its answers and reports led through the forger."""
    behind, answered, reported = Behind({"pace": PACE}), server.answer, XArmEmulator.reported

    def answer(box: Any, frame: Any) -> bytes:
        return bytes(forger.passed(bytes([frame.register]) + frame.payload, answered(box, frame)))

    held, due = [0.0], set[Any]()
    _forger.append(forger)

    def report(box: Any, to: Any, port: int) -> bytes:
        now = time.monotonic()
        if (
            now < held[0] and not _judged.is_set()
        ):  # the process that sends set-points reads reports, too: each reader gets the same, once
            if to not in due:
                return b""
            due.discard(to)
            _sent_at[:] = [now]
            return bytes(forger.sent[-1][1])
        forged = len(forger.sent)
        said = bytes(forger.passed(b"report" + str(port).encode(), reported(box, to, port)))
        if len(forger.sent) > forged:
            held[0] = now + HOLDS
            _judged.clear()
            due.clear()
            due.update(other for other in box._readers if other is not to)
            _sent_at[:] = [now]
        return said

    server.answer, XArmEmulator.reported = answer, report  # type: ignore[method-assign]
    running = emulator("xarm").started({"it": (case.entry, behind)})
    try:
        entry = case.entry
        yield DeviceEntry(
            driver=entry.driver, address={**entry.address, **running.address}, identity=entry.identity,
            settings=entry.settings,
        ), behind  # fmt: skip
    finally:
        running.close()
        server.answer, XArmEmulator.reported = answered, reported  # type: ignore[method-assign]


# what is asked

_forger = list[Any]()
_sent_at = [0.0]
READ = 0.2
"""Within this the library has read a report [s]."""
_judged = threading.Event()
"""Set once the driver was asked what the replaced report said."""


async def joints(arm: Any) -> Any:
    """Return where the joints are."""
    return tuple((await arm.state()).joints)


async def moving(arm: Any) -> Any:
    """Return whether it moves."""
    return (await arm.state()).moving


async def fault(arm: Any) -> Any:
    """Return its fault."""
    return (await arm.state()).fault


async def enabled(arm: Any) -> Any:
    """Return whether it is ready to move, by the next report; got ready again if its link was lost."""
    forger = _forger[-1]
    clean = forger.forge is None
    if (found := await arm.state()).lost or (clean and not found.enabled):
        await arm.ready()
    if clean:  # a report that was cut is noticed some reports later
        await asyncio.sleep(0.4)
    else:
        ends = time.monotonic() + 2.0
        while forger.forge is not None and time.monotonic() < ends:
            await asyncio.sleep(0.005)
        while time.monotonic() < _sent_at[-1] + READ:  # a true report may still be on its way before it
            await asyncio.sleep(0.005)
    found = await arm.state()
    _judged.set()
    return None if found.lost or (clean and not found.enabled) else (found.enabled, found.fault)


async def width(gripper: Any) -> Any:
    """Return how far its fingers are apart [mm]."""
    return (await gripper.grip()).width


async def holds(gripper: Any) -> Any:
    """Return whether it says that it holds something."""
    return (await gripper.grip()).holds


async def claw_fault(gripper: Any) -> Any:
    """Return the number of its fault."""
    found = await gripper.faults()
    return int(found[0].number.lstrip("G")) if found else 0


# what is behind it


def posture(draw: random.Random) -> tuple[str, Any]:
    """Draw where the joints are."""
    return "joints", tuple(draw.uniform(-1.5, 1.5) for _ in range(7))


def position(draw: random.Random) -> tuple[str, Any]:
    """Draw where the fingers are."""
    return "pulses", draw.randrange(PULSES + 1)


# what it means


def _values(sent: bytes, true: bytes, size: int) -> bytes | None:
    """Return the values of an answer of the control port; None if it is none to the question."""
    end = 6 + struct.unpack(">H", sent[4:6])[0] if len(sent) >= 6 else 0
    if len(sent) < end or end != 8 + size or sent[:7] != true[:7] or sent[7] & 0x08:
        return None  # what follows belongs to the next answer
    return sent[8:end]


def joints_of(sent: bytes, true: bytes, _: Any) -> Allowed:
    """Seven finite angles within what a joint can turn."""
    values = _values(sent, true, 28)
    if values is None:
        return NOTHING
    found = struct.unpack("<7f", values)
    if not all(math.isfinite(v) and abs(v) <= RANGE for v in found):
        return NOTHING
    return Allowed(tuple(round(v, 6) for v in found), unknown=sent != true)


def moving_of(sent: bytes, true: bytes, _: Any) -> Allowed:
    """1 moves; 2 ready, 3 paused, 4 stopped, 5 reset and 6 stopping do not."""
    values = _values(sent, true, 1)
    if values is None or not 1 <= values[0] <= 6:
        return NOTHING
    return Allowed(values[0] == 1, unknown=sent != true)


def fault_of(sent: bytes, true: bytes, _: Any) -> Allowed:
    """The number of the fault, 0 for none."""
    values = _values(sent, true, 2)
    return NOTHING if values is None else Allowed(values[0], unknown=sent != true)


def enabled_of(sent: bytes, true: bytes, _: Any) -> Allowed:
    """All seven motors are enabled, by the report; the fault is asked for."""
    if len(sent) < len(true) or sent[:4] != true[:4]:
        return Allowed((True, 0))  # it is no report yet, and what the one before it said is not old
    # the library may notice only now that the stream was broken before
    return Allowed((sent[ENABLED] & 0x7F == 0x7F, 0))


def _modbus(sent: bytes, true: bytes, count: int) -> bytes | None:
    """Return the registers that a reply of the gripper holds."""
    values = _values(sent, true, 4 + count)
    if values is None or values[:4] != bytes([9, 8, 3, count]):
        return None
    return values[4:]


def width_of(sent: bytes, true: bytes, _: Any) -> Allowed:
    """A number of pulses, from shut to open; up to 5 % beyond at either end."""
    found = _modbus(sent, true, 4)
    pulses = struct.unpack(">i", found)[0] if found is not None else 10**9
    if not -0.05 * PULSES <= pulses <= 1.05 * PULSES:
        return NOTHING
    return Allowed(pulses * 84.0 / PULSES, unknown=sent != true)


def holds_of(sent: bytes, true: bytes, _: Any) -> Allowed:
    """The lowest two bits of the status: 2 holds something, 0 and 1 do not, 3 is none."""
    found = _modbus(sent, true, 2)
    if found is None or found[1] & 3 == 3:
        return NOTHING
    return Allowed(found[1] & 3 == 2, unknown=sent != true)


def claw_fault_of(sent: bytes, true: bytes, _: Any) -> Allowed:
    """The number of its fault."""
    found = _modbus(sent, true, 2)
    return NOTHING if found is None else Allowed(struct.unpack(">H", found)[0], unknown=sent != true)


# other forms, and what is none


def with_warning(reply: bytes, draw: random.Random) -> bytes:
    """The same with a warning, or not ready."""
    return reply[:7] + bytes([reply[7] | draw.choice([0, 0x20, 0x10, 0x30])]) + reply[8:]


def other_joints(reply: bytes, draw: random.Random) -> bytes:
    """Other joints."""
    return with_warning(reply, draw)[:8] + struct.pack("<7f", *(draw.uniform(-3, 3) for _ in range(7)))


def other_motors(reply: bytes, draw: random.Random) -> bytes:
    """The same report with other motors enabled."""
    return reply[:ENABLED] + bytes([draw.choice([0x7F, 0x7F, 0xFF, 0, 0x3F])]) + reply[ENABLED + 1 :]


ODD_JOINTS: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    lambda reply, draw: reply[:8] + struct.pack("<7f", *[math.nan] * 7),
    lambda reply, draw: reply[:12] + struct.pack("<f", math.inf) + reply[16:],
    lambda reply, draw: reply[:12] + struct.pack("<f", 1e6) + reply[16:],
    lambda reply, draw: reply[:4] + struct.pack(">H", 6) + reply[6:12],
    lambda reply, draw: reply[:4] + struct.pack(">H", 2) + reply[6:8],
    lambda reply, draw: reply[:7] + bytes([0x08]) + reply[8:],
)
"""No numbers, impossible ones, too few of them, a request that is called invalid."""


ODD_STATE: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    lambda reply, draw: reply[:8] + bytes([draw.choice([0, 9, 77, 255])]) + reply[9:],
    lambda reply, draw: reply[:4] + struct.pack(">H", 2) + reply[6:8],
    lambda reply, draw: reply[:4] + struct.pack(">H", len(reply) - 5) + reply[6:] + b"\1",
    lambda reply, draw: reply[:6] + bytes([JOINTS]) + reply[7:],
    lambda reply, draw: reply[:7] + bytes([0x08]) + reply[8:],
)
"""States that there are not, too few and too many values, the answer of another register, one called invalid."""
ODD_REPORT: tuple[Callable[[bytes, random.Random], bytes], ...] = (
    lambda reply, draw: struct.pack(">I", draw.choice([0, 4, 145, 586, 588])) + reply[4:],
    lambda reply, draw: reply[: draw.randrange(len(reply))],
    lambda reply, draw: reply[:7] + struct.pack("<7f", *[math.nan] * 7) + reply[35:],
    lambda reply, draw: reply[:4] + bytes(len(reply) - 4),
)
"""Another length, a piece of a report, no numbers, nothing but zeros."""


def odd(*forms: Callable[[bytes, random.Random], bytes]) -> Callable[[bytes, random.Random], bytes]:
    """Return what makes one of some odd replies of a true one."""

    def made(reply: bytes, draw: random.Random) -> bytes:
        return draw.choice(forms)(reply, draw)

    return made


def ill_modbus(reply: bytes, draw: random.Random) -> bytes:
    """The reply of another slave or function, an exception, one of another length, or its values alone are noise."""
    body = bytearray(reply)
    kind = draw.randrange(5)
    if kind == 0:
        body[9] = draw.randrange(256)
    elif kind == 1:
        body[10] |= 0x80
    elif kind == 2:
        body[11] = draw.randrange(256)
    elif kind == 3:
        return reply[:4] + struct.pack(">H", len(reply) - 7) + reply[6:-1]
    else:
        body[12:] = bytes(draw.randrange(256) for _ in body[12:])
    return bytes(body)
