"""Zaber stages through the vendor's zaber-motion, in counts: what unit a count is says the lab (`counts_per_unit`), for
the library knows it only from an online database. Every reply carries the number of its question, and a checksum."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.drivers.bus import LONGEST, Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    from zaber_motion.ascii import Connection

REPLY = 800
"""How long a reply may take [ms]."""
_FAULTS = {"FS": "it is stalled", "FE": "it fell behind", "FB": "its driver is too warm or not supplied",
           "FO": "its driver is off", "FH": "it did not find its home"}  # fmt: skip
_POLL = 0.02
_REACHED = 2.0
"""How many counts from where it was sent a stage may come to rest."""


def _opened(entry: DeviceEntry) -> Connection:
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
        self._line = Line(name, bus, entry.identity, self._identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def position(self) -> float | None:
        """Return where it is; None before it was homed."""

        def read(link: Connection) -> float | None:
            reply = self._asked(link, "get pos")
            return None if reply.warning_flag in ("WR", "WH") else float(reply.data) / self._counts

        return await self._line.ask("tell where it is", read)

    async def move_to(self, position: float) -> float:
        """Drive there, in the unit of its counts."""
        if self._limits:
            require_within(self.name, "position", position, self._limits, "(the unit of its counts)")
        at = await self._moved(f"drive to {position:g}", f"move abs {round(position * self._counts)}")
        if abs(at - position) * abs(self._counts) > _REACHED:
            text = f"{self.name} came to rest at {at:.6g}, and was to drive to {position:g}"
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
        await self._line.move(what, lambda link: self._asked(link, command))
        last, since = float("nan"), time.monotonic()
        while True:
            reply = await self._line.ask(what, lambda link: self._asked(link, "get pos"))
            self._line.require_running(stops, what)
            at = float(reply.data) / self._counts
            if reply.status != "BUSY":
                return at
            if at != last:
                last, since = at, time.monotonic()
            elif time.monotonic() - since > LONGEST:
                await self.stop()
                text = f"{self.name} says it moves, and has not for {LONGEST:g} s: {what}"
                raise PicoError(error("device-late", text, address=self.name))
            await asyncio.sleep(_POLL)

    def _asked(self, link: Connection, command: str) -> Any:
        reply = link.generic_command(command, self._device, self._axis, True, REPLY)
        if reply.warning_flag in _FAULTS:
            link.generic_command("warnings clear", self._device, self._axis, False, REPLY)
            text = f"{self.name} reports: {_FAULTS[reply.warning_flag]} (Zaber {reply.warning_flag})"
            hint = "look whether anything keeps it from moving, then home it"
            raise PicoError(error("device-fault", text, hint=hint, address=self.name))
        return reply

    def _identity(self, link: Connection) -> Identity:
        serial, model, firmware = (
            link.generic_command(f"get {setting}", self._device, 0, True, REPLY).data
            for setting in ("system.serial", "deviceid", "version")
        )
        return Identity(vendor="Zaber", model=model, serial=serial, firmware=firmware)


STAGE = Driver(
    kind="axis", made=Stage, opened=_opened, closed=lambda link: link.close(),
    address={"host": "its IP address, where it has one", "port": "the TCP port, or the serial port",
             "device": "its number in the chain", "axis": "the number of its axis"},
    bus=("host", "port"), properties={"position": "mm or deg"}, needs=("zaber_motion.ascii", "zaber"),
    maturity="emulated", emulator="zaber", link="zaber",
)  # fmt: skip
