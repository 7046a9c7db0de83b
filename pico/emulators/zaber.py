"""A Zaber stage on a TCP port, as the vendor's ASCII protocol manual describes it: `/device axis id command`, answered
by `@device axis id flag status warning data`, both with a checksum where the host has sent one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.drivers.zaber import SPEED_UNIT
from pico.drivers.zaber_gantry import AXES, of_axis
from pico.emulators.behind import Behind, Emulator
from pico.emulators.motion import Motion
from pico.emulators.serving import TcpServed
from pico.model.wiring import DeviceEntry

TRAVEL = 101.6
"""How far a stage goes without a scenario [mm]."""
GANTRY = "zaber.gantry"
"""The driver whose entry is several stages."""
DEVICE_ID = 50081
"""Of an X-LSM stage."""


class Stage:
    """One axis, in its own counts. `position` [mm] is behind it, and `stuck` [mm], where it is not None, is where it
    does not get past; it drops what it was told when it is told to stop."""

    def __init__(self, entry: DeviceEntry, behind: Behind) -> None:
        self.serial = str(entry.identity.get("serial", "12345"))
        self.firmware = str(entry.identity.get("firmware", "7.38"))
        self._counts = float(entry.setting("counts_per_unit", 1.0))
        self._speed = float(entry.setting("emulated_speed", 26.0))
        self._behind = behind
        self._motion: Motion | None = None
        self._slip = 0.0  # by how much the counter is ahead of where the stage is [mm]
        self._warning, self._homed = "--", behind.read("homed") is True

    def reply(self, words: list[str]) -> str:
        """Return flag, status, warning and data of the reply to a command, all of one moment."""
        now = self._behind.now()
        self._go_on(now)
        flag, data = self._said(words, now)
        status = "IDLE" if self._motion is None else "BUSY"
        warning = self._warning if self._homed or self._warning != "--" else "WR"
        return f"{flag} {status} {warning} {data}"

    def _said(self, words: list[str], now: float) -> tuple[str, str]:
        match words:
            case ["get", setting] if (found := self._setting(setting, now)) is not None:
                return "OK", found
            case ["move", "abs", counts, *limits] if self._homed and all(one.isdigit() for one in limits):
                position = int(counts) / self._counts
                low, high = self._travel()
                if not low <= position <= high:
                    return "RJ", "BADDATA"
                self._go(
                    position - self._slip, now, int(limits[0]) / SPEED_UNIT / abs(self._counts) if limits else None
                )
            case ["home"]:
                self._homed = True
                self._behind.write("homed", True)
                self._slip = 0.0
                self._go(0.0, now)
            case ["stop"]:
                self._behind.write("position", self._at(now))
                self._motion = None
            case ["warnings"] | ["warnings", "clear"]:
                return "OK", self._warnings(clear=len(words) == 2)
            case [_, *_]:
                return "RJ", "BADCOMMAND"
        return "OK", "0"

    def reboot(self) -> None:
        """Restart: where the stage is stays so, but it knows no reference any more."""
        self._motion, self._warning, self._homed = None, "--", False
        self._behind.write("homed", False)

    def _travel(self) -> tuple[float, float]:
        return self._behind.read("travel") or (0.0, TRAVEL)

    def _warnings(self, *, clear: bool) -> str:
        flags = [] if self._warning == "--" else [self._warning]
        flags += [] if self._homed else ["WR"]
        if clear:
            self._warning = "--"
        return " ".join([f"{len(flags):02d}", *flags])

    def _setting(self, name: str, now: float) -> str | None:
        known = {
            "pos": str(round((self._at(now) + self._slip + (self._behind.read("noise") or 0.0)) * self._counts)),
            "limit.min": str(round(self._travel()[0] * self._counts)),
            "limit.max": str(round(self._travel()[1] * self._counts)),
            "system.serial": self.serial, "deviceid": str(DEVICE_ID),
            "version": self.firmware, "limit.home.triggered": str(int(self._homed)), "system.axiscount": "1",
        }  # fmt: skip
        return known.get(name)

    def _go(self, position: float, now: float, speed: float | None = None) -> None:
        stuck = self._behind.read("stuck")
        begin = self._at(now)
        lost = (position - begin) * (self._behind.read("lost_steps") or 0.0)
        self._slip += lost
        end = position - lost + (self._behind.read("settle_error") or 0.0)
        self._motion = Motion(begin, end, now, speed or self._speed, stuck)

    def _go_on(self, now: float) -> None:
        if self._motion is None:
            return
        self._behind.write("position", self._motion.at(now))
        if self._motion.ended(now):
            self._warning = "FS" if self._motion.reached != self._motion.end else self._warning
            self._motion = None

    def _at(self, now: float) -> float:
        return self._motion.at(now) if self._motion else float(self._behind.read("position") or 0.0)


class OfAxis:
    """What is behind one stage of a gantry, of what is behind all of it: there its properties are `x position`, ..."""

    def __init__(self, behind: Behind, axis: str) -> None:
        self._behind, self._axis = behind, axis

    def read(self, what: str) -> Any:
        return self._behind.read(f"{self._axis} {what}")

    def write(self, what: str, value: Any) -> None:
        self._behind.write(f"{self._axis} {what}", value)

    def now(self) -> float:
        return self._behind.now()


class Chain:
    """Stages by device number."""

    def __init__(self, stages: Mapping[int, Stage]) -> None:
        self._stages, self._rest = stages, b""

    def heard(self, data: bytes) -> bytes:
        *lines, self._rest = (self._rest + data).split(b"\n")
        return b"".join(self._answer(line.decode("ascii", "replace").strip()) for line in lines)

    def due(self) -> bytes:
        return b""

    def _answer(self, line: str) -> bytes:
        if not line.startswith("/"):
            return b""
        body, _, checksum = line[1:].partition(":")
        if checksum and f"{_checksum(body):02X}" != checksum.upper():
            return b""
        words = body.split()
        numbers = [int(w) for w in words[:3] if w.isdigit()]
        device, axis, *message = [*numbers, 0, 0][: max(2, len(numbers))]
        asked = [device] if device else sorted(self._stages)
        return b"".join(self._one(d, axis, message, words[len(numbers) :], bool(checksum)) for d in asked)

    def _one(self, device: int, axis: int, message: list[int], words: list[str], summed: bool) -> bytes:
        if device not in self._stages:
            return b""
        number = f" {message[0]:02d}" if message else ""
        said = f"{device:02d} {axis}{number} {self._stages[device].reply(words)}"
        return f"@{said}:{_checksum(said):02X}\r\n".encode() if summed else f"@{said}\r\n".encode()


def _checksum(text: str) -> int:
    return (256 - sum(text.encode()) % 256) % 256


def _started(devices: Mapping[str, tuple[DeviceEntry, Behind]]) -> TcpServed:
    chain: dict[int, Stage] = {}
    for entry, behind in devices.values():
        if entry.driver == GANTRY:
            for axis in AXES:
                one = of_axis(entry, axis)
                chain[int(one.address["device"])] = Stage(one, OfAxis(behind, axis))
        else:
            chain[int(entry.address.get("device", 1))] = Stage(entry, behind)
    served = TcpServed(lambda: Chain(chain))

    def reboot() -> None:
        for stage in chain.values():
            stage.reboot()

    served.reboot = reboot
    return served


CHAIN = Emulator(started=_started, bus=("host", "port"))
