"""Thorlabs Elliptec rotation mounts (ELL14), through the Apache-licensed package `thorlabs-elliptec-motorized-stages`.

Several share a serial line. A move is begun, then asked about, so that a stop has its turn in between. The vendor's
manual tells `st` for continuous motion; whether a single move obeys it is to be tried on a device: one takes 1 s.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.drivers.bus import LONGEST, Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    from ElliptecBus.elliptec_bus import ElliptecBus, Packet

HOMED = 143361
"""The jog step [pulses] of a mount that was homed since it has power: it forgets that with its zero."""
REACHED = 0.1
"""How far from where it was sent a mount may come to rest [deg]."""
_BUSY = 9
_REPLY = 0.9
"""How long a mount may take for a reply [s]."""
_END, _DIGITS = b"\r\n", 8
"""What ends a reply, and how many digits a position has."""


def _opened(entry: DeviceEntry) -> ElliptecBus:
    from ElliptecBus.elliptec_bus import ElliptecBus

    return ElliptecBus(str(entry.address["port"]), timeout=_REPLY)


class Rotator:
    """A rotation mount: an `Axis` in deg."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[ElliptecBus]) -> None:
        self.name = name
        self._at = str(entry.address.get("bus", "0"))
        self._limits = entry.limits.get("angle", (0.0, 360.0))
        self._pulses = 0
        self._line = Line(name, bus, entry.identity, self._identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def position(self) -> float | None:
        """Return its angle [deg], None where it was not homed since it has power."""

        def read(bus: ElliptecBus) -> float | None:
            homed = bus.decode_long(self._asked(bus, "gj", "GJ").data) == HOMED
            return self._degrees(self._asked(bus, "gp", "PO")) if homed else None

        return await self._line.ask("tell its angle", read)

    async def move_to(self, position: float) -> float:
        """Turn to an angle [deg]."""
        require_within(self.name, "angle", position, self._limits, "deg")
        at = await self._moved(f"turn to {position:g} deg", lambda: "ma" + _hex(position * self._pulses / 360))
        if abs(at - position) > REACHED:
            text = f"{self.name} came to rest at {at:.2f} deg, and was to turn to {position:g} deg"
            raise PicoError(error("device-missed", text, address=self.name))
        return at

    async def home(self) -> float:
        """Turn to its zero, and take that for 0 deg."""
        at = await self._moved("find its zero", lambda: "ho0")
        await self._line.ask("keep that it was homed", lambda bus: self._asked(bus, f"sj{_hex(HOMED)}", "GS"))
        return at

    async def stop(self) -> None:
        await self._line.stop(lambda bus: self._asked(bus, "st", "GS", "PO"))

    async def close(self) -> None:
        await self._line.close()

    async def _moved(self, what: str, command: Callable[[], str]) -> float:
        """Begin to move, and return where it is at rest [deg]; raises PicoError where it fails, or takes too long."""
        stops = self._line.stops

        def begin(bus: ElliptecBus) -> None:
            _fresh(bus)
            bus.write(command(), address=self._at)

        await self._line.move(what, begin)
        ends = time.monotonic() + LONGEST
        while time.monotonic() < ends:
            at = await self._line.ask(what, self._at_rest)
            self._line.require_running(stops, what)
            if at is not None:
                return at
            await asyncio.sleep(0)
        await self.stop()
        raise PicoError(error("device-late", f"{self.name} still moves after {LONGEST:g} s: {what}", address=self.name))

    def _at_rest(self, bus: ElliptecBus) -> float | None:
        """Return where it is at rest [deg]; None while it moves. Raises PicoError for what it says went wrong."""
        packet = _heard(bus, 0.05) or self._asked(bus, "gs", "GS")
        if packet.address != self._at:
            return None
        if packet.command == "PO":
            return self._degrees(packet)
        return None if self._status(packet) == _BUSY else self._degrees(self._asked(bus, "gp", "PO"))

    def _asked(self, bus: ElliptecBus, command: str, *expected: str) -> Packet:
        """Return the reply to a command; what came before it, and what others on the line say, is passed over."""
        from ElliptecBus.elliptec_bus import ElliptecTimeoutError

        _fresh(bus)
        bus.write(command, address=self._at)
        ends = time.monotonic() + _REPLY
        while (left := ends - time.monotonic()) > 0:
            packet = _heard(bus, left)
            if packet is not None and packet.address == self._at:
                if packet.command == "GS":
                    self._status(packet)
                if packet.command in expected:
                    return packet
        raise ElliptecTimeoutError(f"no {' or '.join(expected)} to {command}")

    def _status(self, packet: Packet) -> int:
        from ElliptecBus.elliptec_bus import STATUS_MESSAGES

        code = int(packet.data, 16)
        if code in (0, _BUSY):
            return code
        text = f"{self.name} reports: {STATUS_MESSAGES.get(code, 'unknown status').lower()} (Elliptec status {code})"
        hint = "look whether anything keeps it from turning; `pico devices check` asks it again"
        raise PicoError(error("device-fault", text, hint=hint, address=self.name))

    def _degrees(self, packet: Packet) -> float:
        from ElliptecBus.elliptec_bus import ElliptecBus

        return float(ElliptecBus.decode_long(packet.data) * 360 / self._pulses)

    def _identity(self, bus: ElliptecBus) -> Identity:
        from ElliptecBase.elliptec_base import parse_in_device_info

        found = parse_in_device_info(self._asked(bus, "in", "IN"))
        self._pulses = found.pulses_per_unit
        return Identity(
            vendor="Thorlabs", model=found.model_name, serial=found.serial_number, firmware=found.firmware_release
        )


def _line_of(bus: ElliptecBus) -> Any:
    """The serial line of a bus; raises ConnectionError where it is closed."""
    if bus._serial is None:
        raise ConnectionError("the line is closed")
    return bus._serial


def _fresh(bus: ElliptecBus) -> None:
    """Forget what was heard. The library's own way also takes back what was said to another mount and is on its way."""
    _line_of(bus).reset_input_buffer()


def _heard(bus: ElliptecBus, within: float) -> Packet | None:
    """Return the next whole reply; None where none came. The library's own way takes a line for whole that was only
    begun when its time was over."""
    from ElliptecBus.elliptec_bus import ElliptecProtocolError

    line = _line_of(bus)
    line.timeout = within
    said = line.read_until(_END)
    if said and not said.endswith(_END):
        line.timeout = _REPLY
        said += line.read_until(_END)
    if not said.endswith(_END):
        return None
    try:
        packet = bus.parse_packet(said.decode("ascii").strip())
    except (ElliptecProtocolError, UnicodeDecodeError):
        return None
    return None if packet.command == "PO" and len(packet.data) != _DIGITS else packet


def _hex(pulses: float) -> str:
    return f"{round(pulses) & 0xFFFFFFFF:08X}"


ROTATOR = Driver(
    kind="axis",
    made=Rotator,
    opened=_opened,
    closed=lambda bus: bus.close(),
    address={"port": "the serial port (`/dev/ttyUSB0`)", "bus": "its address on the line, `0` to `F`"},
    bus=("port",),
    properties={"angle": "deg"},
    needs=("ElliptecBus.elliptec_bus", "thorlabs"),
    maturity="emulated",
    emulator="elliptec",
    link="elliptec",
)
