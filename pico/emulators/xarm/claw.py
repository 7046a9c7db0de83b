"""The vendor's gripper at the arm's end: Modbus RTU inside register 124, with registers of its own.

It counts pulses, `PULSES` from shut to open. Its registers are those that the vendor's manual of the gripper lists;
which bits of the status mean what is as its library reads them: 0 at rest, 1 moving, 2 holding something.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass

PULSES = 850
STATUS, ERROR, ENABLE, MODE, CLEAR, SPEED, TARGET, POSITION = (
    0x0000,
    0x000F,
    0x0100,
    0x0101,
    0x0109,
    0x0303,
    0x0700,
    0x0702,
)
VERSION = {0x0801: 3, 0x0802: 4, 0x0803: 9}
_SLOWEST = 350.0  # pulses/s
_UNKNOWN, _BAD_VALUE = 2, 3


@dataclass
class Claw:
    """A gripper; `stroke` [mm] from shut to open. `fingers(wanted, now)` says how far apart [mm] they come to rest."""

    stroke: float = 84.0
    pulses: float = float(PULSES)
    target: float = float(PULSES)
    ends: float = float(PULSES)
    speed: float = 1500.0
    enabled: bool = False
    error: int = 0
    now: float = 0.0
    fingers: Callable[[float, float], float] | None = None

    @property
    def width(self) -> float:
        """How far apart its fingers are [mm]."""
        return self.pulses * self.stroke / PULSES

    @property
    def status(self) -> int:
        if abs(self.pulses - self.ends) > 1e-9:
            return 1
        return 2 if abs(self.ends - self.target) > 1.0 else 0

    def advance(self, now: float) -> None:
        """Go on to a later time [s of the emulated clock]."""
        most = max(_SLOWEST, self.speed) * max(0.0, now - self.now)
        self.now = max(now, self.now)
        if self.enabled and not self.error:
            self.pulses += max(-most, min(most, self.ends - self.pulses))

    def go(self, target: float) -> None:
        """Take where to go [pulses]."""
        self.target = max(0.0, min(float(PULSES), target))
        wanted = self.target * self.stroke / PULSES
        reached = self.fingers(wanted, self.width) if self.fingers else wanted
        self.ends = max(0.0, min(float(PULSES), reached * PULSES / self.stroke))

    def answer(self, request: bytes) -> bytes:
        """Return the answer to a Modbus request: its slave, function and what follows, without checksums."""
        slave, function = request[0], request[1]
        try:
            values = self._read(request[2:]) if function == 3 else self._write(request[2:]) if function == 16 else None
        except (struct.error, KeyError):
            values = None
        if values is None:
            return bytes([slave, function | 0x80, _UNKNOWN])
        return bytes([slave, function]) + values

    def _read(self, payload: bytes) -> bytes:
        address, count = struct.unpack(">HH", payload[:4])
        known = {STATUS: self.status, ERROR: self.error, ENABLE: int(self.enabled), SPEED: int(self.speed), **VERSION}
        if address == POSITION and count == 2:
            return bytes([4]) + struct.pack(">i", round(self.pulses))
        if count != 1:
            raise KeyError(address)
        return bytes([2]) + struct.pack(">H", known[address])

    def _write(self, payload: bytes) -> bytes:
        address, count, size = struct.unpack(">HHB", payload[:5])
        value = int.from_bytes(payload[5 : 5 + size], "big", signed=True)
        if address == ENABLE:
            self.enabled = bool(value)
        elif address == CLEAR:
            self.error = 0
        elif address == SPEED:
            self.speed = float(value)
        elif address == TARGET and count == 2:
            self.go(float(value))
        elif address != MODE:
            raise KeyError(address)
        return payload[:4]
