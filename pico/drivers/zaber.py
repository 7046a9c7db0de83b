"""Zaber stages through the vendor's zaber-motion, in counts: what unit a count is says the lab (`counts_per_unit`), for
the library knows it only from an online database. Every reply carries the number of its question, and a checksum."""

from __future__ import annotations

import asyncio
import re
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.drivers import judging
from pico.drivers.bus import LONGEST, Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.model.instruments.declaration import Setting
from pico.model.instruments.readout import Readout, unknown
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    from zaber_motion.ascii import Connection

REPLY = 800
"""How long a reply may take [ms]."""
_FAULTS = {
    "FF": "it has a critical system error", "FN": "its peripheral is not supported",
    "FZ": "its peripheral is inactive", "FH": "the emergency stop of its hardware has disabled its driver",
    "FV": "its supply is too high or too low, and its driver off", "FO": "its driver is off",
    "FC": "its inrush current was too high", "FM": "its motor is too warm", "FD": "its driver is off",
    "FQ": "its encoder reports an error", "FI": "the index of its encoder is wrong",
    "FA": "its analog encoder lost synchronism", "FR": "it was overdriven", "FS": "it is stalled",
    "FB": "a sequence left its bounds", "FP": "it left its path", "FE": "it ran into a limit",
    "FT": "it is twisted too far", "WL": "a limit switch stopped it",
}  # fmt: skip
"""Flags of replies by which a motion or a position can't be relied on (the vendor's ASCII protocol, warning flags)."""
_INTERRUPTED = {"NI": "another command interrupted its motion", "NC": "a person drives it by its knob"}
_NO_ZERO = ("WR", "WH")
"""It has no reference position, or was not homed."""
_POLL = 0.02
_FLAG = re.compile("[FWN][A-Z]")
_WARNING = re.compile(r"--|[A-Z][A-Z0-9]")
SPEED_UNIT, ACCELERATION_UNIT = 1.6384, 1.6384e-4
"""What a count a second, and a count a second squared, are in the numbers of the protocol."""
_REACHED = 2.0
"""How many counts from where it was sent a stage may come to rest."""


def opened(entry: DeviceEntry) -> Connection:
    from zaber_motion.ascii import Connection

    port = entry.address["port"]
    if host := entry.address.get("host"):
        link = Connection.open_tcp(str(host), int(port))
    else:
        link = Connection.open_serial_port(str(port))
    link.default_request_timeout = REPLY
    link.checksum_enabled = True
    return link


class Stage:
    """One axis of a stage: an `Axis` in the unit that `counts_per_unit` is of."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Any]) -> None:
        self.name = name
        self._device, self._axis = int(entry.address.get("device", 1)), int(entry.address.get("axis", 1))
        counts = entry.settings.get("counts_per_unit")
        if not isinstance(counts, int | float) or counts == 0:
            hint = "the vendor's page of the stage has its microstep size: 1 / that"
            text = f"{name} does not say how many counts a mm or a degree is"
            raise PicoError(error("device", text, hint=f"`settings: {{counts_per_unit: ...}}`; {hint}", address=name))
        self._counts = float(counts)
        self._limits = entry.limits.get("position")
        self._unit = STAGE.unit(entry, "position")
        self._line = Line(name, bus, entry.identity, self._identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def position(self) -> float | None:
        """Return where it is; None before it was homed."""
        return (await self.readout()).number

    async def readout(self) -> Readout:
        """Return where it is, with the reply; unknown before it was homed."""

        def read(link: Connection) -> Readout:
            reply = self._asked(link, "get pos")
            raw = f"{reply.status} {reply.warning_flag} {reply.data}"
            if set(_NO_ZERO) & self._flags(link, reply):
                return unknown(self._unit, "not-homed", raw)
            again = self._asked(link, "get pos")
            if reply.status == again.status == "IDLE" and reply.data != again.data:
                why = f"at rest it says {reply.data[:20]}, then {again.data[:20]}"
                return unknown(self._unit, "garbled", raw, why)
            return Readout(unit=self._unit, value=self._position(reply), raw=raw)

        return await self._line.ask("tell where it is", read)

    async def readouts(self) -> Mapping[str, Readout]:
        """Return what it reads of its properties, with the replies."""
        return {"position": await self.readout()}

    async def move_to(self, position: float, *, speed: float | None = None, acceleration: float | None = None) -> float:
        """Drive there, in the unit of its counts; with `speed` and `acceleration`, for this move only, no faster [unit
        per s, unit per s2] (firmware 7.25 and later). Raises PicoError for one that was not homed: its counts begin
        anywhere."""
        if self._limits:
            require_within(self.name, "position", position, self._limits, self._unit)
        command = f"move abs {round(position * self._counts)}"
        if speed is not None and acceleration is not None:
            limits = speed * SPEED_UNIT, acceleration * ACCELERATION_UNIT
            command += "".join(f" {max(1, round(limit * abs(self._counts)))}" for limit in limits)
        at = await self._moved(f"drive to {position:g} {self._unit}", command)
        if abs(at - position) * abs(self._counts) > _REACHED:
            text = f"{self.name} came to rest at {at:.6g}, and was to drive to {position:g} {self._unit}"
            raise PicoError(error("device-missed", text, address=self.name))
        return at

    async def home(self) -> float:
        """Drive to its zero."""
        return await self._moved("find its zero", "home")

    async def stop(self) -> None:
        await self._line.stop(lambda link: self._asked(link, "stop"))

    async def close(self) -> None:
        await self._line.close()

    async def _moved(self, what: str, command: str) -> float:
        """Begin to move, and return where it is at rest; raises PicoError where it fails, or stands still too late."""
        stops = self._line.stops

        def begin(link: Connection) -> None:
            flags = self._flags(link, self._asked(link, "get pos"))
            if command != "home" and flags & set(_NO_ZERO):
                text = f"{self.name} does not know where it is: it was not homed since it has power"
                raise PicoError(error("device-unhomed", text, hint="home it first", address=self.name))
            if flags & _INTERRUPTED.keys():  # of an earlier motion: it is kept until it is cleared
                link.generic_command("warnings clear", self._device, self._axis, False, REPLY)
            self._asked(link, command)

        await self._line.move(what, begin)
        last, since = float("nan"), time.monotonic()
        while True:
            reply = await self._line.ask(what, lambda link: self._asked(link, "get pos"))
            self._line.require_running(stops, what)
            at = self._position(reply)
            if reply.status != "BUSY":
                again = await self._line.ask(what, lambda link: self._asked(link, "get pos"))
                if (
                    again.data != reply.data
                ):  # one of the two was damaged on the way, and no checksum of it is asked for
                    continue
                flags = await self._line.ask(what, lambda link, reply=reply: self._flags(link, reply))  # type: ignore[misc]
                for flag in sorted(flags & _INTERRUPTED.keys()):
                    text = f"{self.name} reports: {_INTERRUPTED[flag]} (Zaber {flag}): {what}"
                    raise PicoError(error("device-fault", text, hint="plan again", address=self.name))
                return at
            if at != last:
                last, since = at, time.monotonic()
            elif time.monotonic() - since > LONGEST:
                await self.stop()
                text = f"{self.name} says it moves, and has not for {LONGEST:g} s: {what}"
                raise PicoError(error("device-late", text, address=self.name))
            await asyncio.sleep(_POLL)

    def _position(self, reply: Any) -> float:
        found = judging.number(str(reply.data), self._unit)
        if found.number is None:
            text = f"{self.name} does not tell its position: {found.why}"
            raise PicoError(error("device-reply", text, address=self.name))
        return found.number / self._counts

    def _flags(self, link: Connection, reply: Any) -> set[str]:
        """Return all flags of the axis; a reply holds only the one that is most urgent, which may hide another."""
        first = str(reply.warning_flag)
        if first == "--":
            return set()
        listed = str(link.generic_command("warnings", self._device, self._axis, False, REPLY).data).split()[1:]
        return {first, *(flag for flag in listed if _FLAG.fullmatch(flag))}

    def _asked(self, link: Connection, command: str) -> Any:
        reply = link.generic_command(command, self._device, self._axis, True, REPLY)
        if reply.warning_flag in _FAULTS:
            link.generic_command("warnings clear", self._device, self._axis, False, REPLY)
            text = f"{self.name} reports: {_FAULTS[reply.warning_flag]} (Zaber {reply.warning_flag})"
            hint = "look whether anything keeps it from moving, then home it"
            raise PicoError(error("device-fault", text, hint=hint, address=self.name))
        if reply.status not in ("IDLE", "BUSY") or not _WARNING.fullmatch(reply.warning_flag):
            raise ValueError(f"status {reply.status[:20]!r}, warning {reply.warning_flag[:20]!r}")
        return reply

    def _identity(self, link: Connection) -> Identity:
        serial, model, firmware = (
            link.generic_command(f"get {setting}", self._device, 0, True, REPLY).data
            for setting in ("system.serial", "deviceid", "version")
        )
        return Identity(vendor="Zaber", model=model, serial=serial, firmware=firmware)


CHAIN = (1, 99)
"""The numbers that a device in a chain may have."""
COUNTS = (0.001, 1e9)
"""What a mm or a degree may have of counts."""

STAGE = Driver(
    kind="axis", made=Stage, opened=opened, closed=lambda link: link.close(),
    address={"host": "its IP address, where it has one", "port": "the TCP port, or the serial port",
             "device": "its number in the chain", "axis": "the number of its axis"},
    bus=("host", "port"), usual={"device": "1", "axis": "1"}, properties={"position": "mm"},
    numbers={"device": CHAIN, "axis": (1, 9)},
    settings={
        "counts_per_unit": Setting(
            range=COUNTS, about="counts a mm or a degree: 1 / the microstep size on the vendor's page"
        ),
        "unit": Setting(kind=str, default="mm", choices=("mm", "deg"), about="what unit the counts are of"),
        "emulated_speed": Setting(default=26.0, unit="/s", range=(0.001, 1e4), about="how fast its emulator drives"),
    },
    needs=("zaber_motion.ascii", "zaber"), maturity="emulated", emulator="zaber", link="zaber",
)  # fmt: skip
