"""A bus of Thorlabs Elliptec devices on a serial line, as the vendor's protocol manual describes them: rotation mounts
ELL14, linear stages ELL17 and ELL20, and sliders ELL6, ELL9 and ELL12.

ASCII without terminators from the host, replies end in CRLF: `<address><two letters><hex>`. `in` who, `gs` status
(reading it clears it), `gp` position, `ma` and `mr` moves, `ho` home, `st` stop, `gj` and `sj` the jog step, kept while
it has power. A move is answered when it has ended: `PO` with the position, or `GS` with what went wrong.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from pico.drivers.elliptec_slider import names_of
from pico.emulators.behind import Behind, Emulator
from pico.emulators.motion import Motion
from pico.emulators.serving import SerialServed
from pico.model.instruments.kind import name_at
from pico.model.wiring import DeviceEntry

PULSES = 143360
"""Of one turn of an ELL14."""
SPEED = 430.0
"""Of an ELL14 [deg/s]."""
SLOWEST = 80.0
"""Of a linear stage at the lowest velocity that can be set, 45 % of 180 mm/s [mm/s]."""
MECHANICAL_TIMEOUT, UNKNOWN_COMMAND, OUT_OF_RANGE, BUSY = 2, 3, 4, 9
_COMMAND = re.compile(rb"([0-9A-F])(in|gs|gp|st|gj|go|fw|bw|ho[01]|(?:ma|mr|sj|so)[0-9A-Fa-f]{8})")


@dataclass(frozen=True)
class Kind:
    """A model: the `code` in its reply to `in`, its travel [deg or mm], pulses a turn or a mm and what that is
    [deg or mm], its speed [deg/s or mm/s], and the driver's property that it moves."""

    code: int
    travel: int
    pulses: int
    per: float
    speed: float
    moves: str
    positions: int = 0
    """How many named positions it has; 0 for an axis."""


KINDS = {
    "ELL14": Kind(0x0E, 360, PULSES, 360.0, SPEED, "angle"),
    "ELL17": Kind(0x11, 28, 1024, 1.0, SLOWEST, "position"),
    "ELL20": Kind(0x14, 60, 1024, 1.0, SLOWEST, "position"),
    "ELL6": Kind(0x06, 31, 0, 1.0, SLOWEST, "position", 2),
    "ELL9": Kind(0x09, 96, 0, 1.0, SLOWEST, "position", 4),
    "ELL12": Kind(0x0C, 95, 0, 1.0, SLOWEST, "position", 6),
}
USUAL = {"elliptec.rotator": "ELL14", "elliptec.stage": "ELL17", "elliptec.slider": "ELL9"}
"""The model that stands in for the devices of a driver."""


NO_NAMES: Mapping[str, str] = MappingProxyType({})


class Mount:
    """One device: what is read and written behind it is where it is [deg or mm], under the name of what it `moves`;
    `stuck`, where it is not None, is where it does not get past."""

    def __init__(
        self, serial: str, behind: Behind, kind: Kind = KINDS["ELL14"], names: Mapping[str, str] = NO_NAMES
    ) -> None:
        """`names`: of the positions of a slider, by their numbers."""
        self.serial, self.behind, self.kind, self._names = serial, behind, kind, names
        self._between: float | None = None
        self._motion: Motion | None = None
        self._status, self._offset = 0, 0
        self._jog = int(behind.read("jog") or kind.pulses // 8)

    def answer(self, command: str) -> str:
        """Return the reply to one command, without address; '' where it comes once the motion has ended."""
        name, hexadecimal = command[:2], command[2:]
        now = self.behind.now()
        if name in ("ma", "mr", "ho", "fw", "bw") and self._motion and not self._motion.ended(now):
            return f"GS{BUSY:02X}"
        if name in ("ma", "mr"):
            asked = _signed(hexadecimal) + (self._pulses(now) if name == "mr" else 0)
            return self._go(asked * self.kind.per / (self.kind.pulses or 1), now)
        if name in ("fw", "bw"):
            return self._stepped(name, now)
        if name == "ho":
            return self._go(self._offset * self.kind.per / (self.kind.pulses or 1), now)
        if name == "st":
            return self._stopped(now)
        return self._told(name, hexadecimal, now)

    def ended(self) -> str:
        """Return what it says of a motion that has ended since, once; and lets the world have it on the way."""
        motion, now = self._motion, self.behind.now()
        if motion is None:
            return ""
        self._write(motion.at(now))
        if not motion.ended(now):
            return ""
        self._motion = None
        if motion.reached != motion.end:
            self._status = MECHANICAL_TIMEOUT
            return f"GS{MECHANICAL_TIMEOUT:02X}"
        return f"PO{_hex(self._pulses(now))}"

    def _told(self, name: str, hexadecimal: str, now: float) -> str:
        if name == "in":
            about = f"{self.kind.travel:04X}{self.kind.pulses:08X}"
            return f"IN{self.kind.code:02X}{self.serial:>08}2026" + "17" + "01" + about
        if name == "gs":
            status = BUSY if self._motion else self._status
            self._status = 0
            return f"GS{status:02X}"
        if name == "gp":
            noise = (self.behind.read("noise") or 0.0) / self.kind.per * self.kind.pulses
            return f"PO{_hex(self._pulses(now) + round(noise))}"
        if name in ("sj", "so"):
            if name == "sj":
                self._jog = _signed(hexadecimal)
                self.behind.write("jog", self._jog)
            else:
                self._offset = _signed(hexadecimal)
            return "GS00"
        return f"GJ{_hex(self._jog)}" if name == "gj" else f"HO{_hex(self._offset)}"

    def _go(self, angle: float, now: float) -> str:
        travel = self.behind.read("travel")
        if travel is not None and not travel[0] <= angle <= travel[1]:
            return f"GS{OUT_OF_RANGE:02X}"
        begin = self._angle(now)
        if self.kind.pulses:
            angle += (self.behind.read("settle_error") or 0.0) - (angle - begin) * (
                self.behind.read("lost_steps") or 0.0
            )
        self._motion = Motion(begin, angle, now, self.kind.speed, self.behind.read("stuck"))
        return ""

    def reboot(self) -> None:
        """Restart: a motion ends where it is, and the status is forgotten."""
        self._stopped(self.behind.now())
        self._status = 0

    def _stopped(self, now: float) -> str:
        if self._motion:
            self._write(self._motion.at(now))
            self._motion = None
        return "GS00"

    def _angle(self, now: float) -> float:
        if self._motion:
            return self._motion.at(now)
        found = self.behind.read(self.kind.moves)
        if not self.kind.positions:
            return float(found or 0.0)
        if self._between is not None:
            return self._between
        name = name_at(self._names.values(), found)
        number = next((int(key) for key, one in self._names.items() if one == name), 1)
        return float(self._places()[number - 1])

    def _stepped(self, name: str, now: float) -> str:
        places, at = self._places(), self._angle(now)
        ahead = [p for p in places if p > at + 2] if name == "fw" else [p for p in reversed(places) if p < at - 2]
        return self._go(float(ahead[0]), now) if ahead else f"GS{OUT_OF_RANGE:02X}"

    def _places(self) -> list[int]:
        """Return where the positions of a slider are [mm]."""
        last = self.kind.positions - 1
        return [round(n * self.kind.travel / last) for n in range(last + 1)]

    def _write(self, at: float) -> None:
        """Let the world have it where it is; a slider at its position, and nowhere in between."""
        if not self.kind.positions:
            self.behind.write(self.kind.moves, at)
            return
        number = next((n for n, place in enumerate(self._places(), 1) if abs(place - at) < 1e-6), 0)
        self._between = None if number and str(number) in self._names else at
        if name := self._names.get(str(number)):
            self.behind.write(self.kind.moves, name)

    def _pulses(self, now: float) -> int:
        return round(self._angle(now) / self.kind.per * (self.kind.pulses or 1))


def _signed(hexadecimal: str) -> int:
    value = int(hexadecimal, 16)
    return value - (1 << 32) if value & (1 << 31) else value


def _hex(value: int) -> str:
    return f"{value & 0xFFFFFFFF:08X}"


class MountBus:
    """Mounts by their bus address, `0` to `F`: whom nobody has is not answered for."""

    def __init__(self, mounts: Mapping[str, Mount]) -> None:
        self._mounts = mounts
        self._rest = b""

    def heard(self, data: bytes) -> bytes:
        self._rest += data
        said = ""
        while self._rest:
            found = _COMMAND.match(self._rest)
            if found:
                self._rest = self._rest[found.end() :]
                address = found[1].decode()
                if (mount := self._mounts.get(address)) and (reply := mount.answer(found[2].decode())):
                    said += f"{address}{reply}\r\n"
            elif len(self._rest) < 11 and re.match(rb"[0-9A-F](?:[a-z]|$)", self._rest):
                break  # the rest of it is still to come
            else:
                self._rest = self._rest[1:]
        return said.encode()

    def due(self) -> bytes:
        replies = ((address, mount.ended()) for address, mount in self._mounts.items())
        return "".join(f"{address}{reply}\r\n" for address, reply in replies if reply).encode()


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> SerialServed:
    mounts = {
        str(entry.address.get("bus", "0")): Mount(
            str(entry.identity.get("serial", "00000000")),
            behind,
            KINDS.get(entry.identity.get("model", ""), KINDS[USUAL.get(entry.driver, "ELL14")]),
            names_of(entry),
        )
        for entry, behind in devices.values()
    }
    served = SerialServed(MountBus(mounts))

    def reboot() -> None:
        for mount in mounts.values():
            mount.reboot()

    served.reboot = reboot
    return served


BUS = Emulator(started=_started, bus=("port",))
