"""Thorlabs Elliptec rotation mounts and linear stages, over the line that the Apache-licensed package
`thorlabs-elliptec-motorized-stages` opens. What a device is it says itself: its type and its pulses a turn or a mm.

Several share a serial line. A move is begun, then asked about, so that a stop has its turn in between. The vendor's
manual tells `st` for continuous motion; whether a single move obeys it is to be tried on a device: one takes 1 s.
"""

from __future__ import annotations

import asyncio
import math
import re
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from pico.diagnostics import PicoError, error
from pico.drivers import judging
from pico.drivers.bus import LONGEST, Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.model.instruments.complaint import Complaint
from pico.model.instruments.readout import Readout, unknown
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    from ElliptecBus.elliptec_bus import ElliptecBus, Packet

HOMED = 143361
"""The jog step [pulses] of an ELL14 that was homed since it has power: it forgets that with its zero."""
REACHED = 0.1
"""How far from where it was sent a mount may come to rest [deg]."""
REACHED_BY_STAGE = 0.1
"""How far from where it was sent a linear stage may come to rest [mm]."""
_BUSY = 9
_REPLY = 0.9
"""How long a mount may take for a reply [s]."""
_END, _DIGITS, _ABOUT = b"\r\n", 8, 30
"""What ends a reply, and how many digits a position and what a device says of itself have."""
_REPLY_LINE = re.compile(rb"([0-9A-F])(PO(?=.{8}\r)|GJ(?=.{8}\r)|GS(?=.{2}\r)|IN(?=.{30}\r))([0-9A-Za-z]+)\r\n")
"""A reply of the protocol that is asked for here: address, two letters, digits."""


def _opened(entry: DeviceEntry) -> ElliptecBus:
    from ElliptecBus.elliptec_bus import ElliptecBus

    return ElliptecBus(str(entry.address["port"]), timeout=_REPLY)


@dataclass(frozen=True)
class Model:
    """A model of the series, by its type code in the reply to `in`."""

    name: str
    travels: Literal["linear", "rotary", "positions"]
    """How it moves; `positions`: a slider or an iris, which is no axis."""


MODELS = {
    0x06: Model("ELL6", "positions"), 0x07: Model("ELL7", "linear"), 0x08: Model("ELL8", "rotary"),
    0x09: Model("ELL9", "positions"), 0x0A: Model("ELL10", "linear"), 0x0C: Model("ELL12", "positions"),
    0x0E: Model("ELL14", "rotary"), 0x0F: Model("ELL15", "positions"), 0x10: Model("ELL16", "rotary"),
    0x11: Model("ELL17", "linear"), 0x12: Model("ELL18", "rotary"), 0x14: Model("ELL20", "linear"),
}  # fmt: skip
"""By the vendor's protocol manual."""
_OF_TRAVEL = {"linear": "elliptec.stage", "rotary": "elliptec.rotator", "positions": "elliptec.slider"}
_FEWEST_A_TURN = 10_000
"""Pulses a turn that any rotary model exceeds, and pulses a mm of a linear one (1024 or 2048) never reach."""
_STANDS = 4
"""How often in a row the same position is read beside the goal until it counts as where it came to rest: some firmware
answers `gs` by 0 while it moves."""


@dataclass(frozen=True)
class About:
    """What a device says of itself: `pulses` a turn or a mm, `travel` [deg or mm]."""

    model: Model
    pulses: int
    travel: int


class Device:
    """A device of the series, which moves in its `unit` and comes to rest within `reached` of where it was sent."""

    travels: Literal["linear", "rotary", "positions"]
    unit: str
    reached: float

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[ElliptecBus]) -> None:
        self.name = name
        self._at = address_of(entry)
        self._about = About(MODELS[0x0E], 1, 0)
        self._line = Line(name, bus, entry.identity, self._identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def stop(self) -> None:
        await self._line.stop(lambda bus: self._asked(bus, "st", "GS", "PO"))

    async def close(self) -> None:
        await self._line.close()

    async def _moved(self, what: str, goal: Callable[[], int], command: str) -> float:
        """Begin to move, and return where it is at rest; raises PicoError where it fails, or takes too long."""
        stops = self._line.stops

        def begin(bus: ElliptecBus) -> None:
            _fresh(bus)
            more = {"ma": _hex(goal()), "ho": "0"}
            bus.write(command + more.get(command, ""), address=self._at)

        await self._line.move(what, begin)
        ends, last, same = time.monotonic() + LONGEST, math.nan, 0
        try:
            while time.monotonic() < ends:
                found = await self._line.ask(what, self._heard_of)
                self._line.require_running(stops, what)
                if found is not None:
                    at, told = found
                    same = same + 1 if at == last else 0
                    last = at
                    near = abs(at - self._of(goal())) <= self.reached
                    if told or same >= (1 if near else _STANDS):
                        return at
                await asyncio.sleep(0)
        except PicoError as exc:
            if exc.diagnostics[0].code == "device-fault":
                with suppress(PicoError):
                    await self._line.ask("clear its status", self._cleared)
            raise
        await self.stop()
        raise PicoError(error("device-late", f"{self.name} still moves after {LONGEST:g} s: {what}", address=self.name))

    def _heard_of(self, bus: ElliptecBus) -> tuple[float, bool] | None:
        """Return where it is, and whether it says so by itself, as it does once a motion has ended; None while it says
        that it moves. Raises PicoError for what it says went wrong."""
        packet = _heard(bus, 0.05) or self._asked(bus, "gs", "GS")
        if packet.address != self._at:
            return None
        if packet.command == "PO":
            return self._position(packet), True
        return None if self._status(packet) == _BUSY else (self._position(self._asked(bus, "gp", "PO")), False)

    def _cleared(self, bus: ElliptecBus) -> None:
        """Read a fault that was told from the device, which keeps it until then: the next question is not about it."""
        _fresh(bus)
        bus.write("gs", address=self._at)
        ends = time.monotonic() + _REPLY
        while (left := ends - time.monotonic()) > 0:
            packet = _heard(bus, left)
            if packet is not None and packet.address == self._at and packet.command == "GS":
                return

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

        code = judging.hexadecimal(packet.data, 2)
        if code in (0, _BUSY):
            return code
        text = f"{self.name} reports: {STATUS_MESSAGES.get(code, 'unknown status').lower()} (Elliptec status {code})"
        hint = "look whether anything keeps it from moving; `pico devices check` asks it again"
        raise PicoError(error("device-fault", text, hint=hint, address=self.name))

    def _position(self, packet: Packet) -> float:
        return self._of(judging.hexadecimal(packet.data, _DIGITS, signed=True))

    def _of(self, pulses: int) -> float:
        """Return the position of a number of pulses, in its unit."""
        return pulses * (360.0 if self.travels == "rotary" else 1.0) / self._about.pulses

    def _identity(self, bus: ElliptecBus) -> Identity:
        packet = self._asked(bus, "in", "IN")
        self._about, who = about(packet.data)
        if (is_ := self._about.model.travels) != self.travels:
            text = f"{self.name} is {_DOES[is_]} ({who.model}), and is wired as {_DOES[self.travels]}"
            hint = f"write `driver: {_OF_TRAVEL[is_]}`"
            raise PicoError(error("device-kind", text, hint=hint, address=self.name))
        return who


class _Axis(Device):
    """An axis of the series: an `Axis` in its unit."""

    prop: str

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[ElliptecBus]) -> None:
        super().__init__(name, entry, bus)
        self._limits = entry.limits.get(self.prop)

    async def position(self) -> float | None:
        """Return where it is, None where it was not homed since it has power."""
        return (await self.readout()).number

    async def readout(self) -> Readout:
        """Return where it is, with the reply; unknown if it was not homed since it has power."""

        def read(bus: ElliptecBus) -> Readout:
            jog = self._asked(bus, "gj", "GJ")
            if judging.hexadecimal(jog.data, _DIGITS, signed=True) != self._mark:
                return unknown(self.unit, "not-homed", jog.raw)
            packet = self._asked(bus, "gp", "PO")
            return Readout(unit=self.unit, value=self._position(packet), raw=packet.raw)

        return await self._line.ask("tell where it is", read)

    async def readouts(self) -> Mapping[str, Readout]:
        """Return what it reads of its properties, with the replies."""
        return {self.prop: await self.readout()}

    async def move_to(self, position: float) -> float:
        """Drive to a position, in its unit."""
        require_within(self.name, self.prop, position, self._limits or self._usual(), self.unit)
        at = await self._moved(f"{self._verb} to {position:g} {self.unit}", lambda: self._pulses(position), "ma")
        if abs(at - position) > self.reached:
            text = (
                f"{self.name} came to rest at {at:.6g} {self.unit}, and was to {self._verb} to {position:g} {self.unit}"
            )
            raise PicoError(error("device-missed", text, address=self.name))
        return at

    async def home(self) -> float:
        """Drive to its zero."""
        at = await self._moved("find its zero", lambda: 0, "ho")
        await self._line.ask("keep that it was homed", lambda bus: self._asked(bus, f"sj{_hex(self._mark)}", "GS"))
        return at

    def _pulses(self, position: float) -> int:
        return round(position * self._about.pulses / self._per)

    @property
    def _per(self) -> float:
        """What its pulses are counted by, in its unit."""
        return 360.0 if self.travels == "rotary" else 1.0

    @property
    def _verb(self) -> str:
        return "turn" if self.travels == "rotary" else "drive"

    @property
    def _mark(self) -> int:
        """The jog step [pulses] that says that it was homed since it has power."""
        return self._about.pulses + 1 if self.travels == "rotary" else self._about.pulses - 1

    def _usual(self) -> tuple[float, float]:
        """Return how far it travels, in its unit; a stage says so itself, once it has answered."""
        return (0.0, 360.0 if self.travels == "rotary" else float(self._about.travel) or math.inf)


_DOES = {"linear": "a linear stage", "rotary": "a rotation mount", "positions": "a slider of named positions"}


def driver_of(model: Model) -> str:
    """Return the name of the driver that moves a model."""
    return _OF_TRAVEL[model.travels]


class Rotator(_Axis):
    """A rotation mount: an `Axis` in deg."""

    travels, prop, unit, reached = "rotary", "angle", "deg", REACHED


class Stage(_Axis):
    """A linear stage: an `Axis` in mm."""

    travels, prop, unit, reached = "linear", "position", "mm", REACHED_BY_STAGE


def about(data: str) -> tuple[About, Identity]:
    """Return what a device says of itself after `IN`: type (2 digits), serial number (8), year (4), firmware (2),
    hardware (2), travel (4), pulses a turn or a mm (8). Raises ValueError for a reply of another form."""
    if len(data) != _ABOUT:
        raise ValueError(f"{data[:40]!r} has not {_ABOUT} digits")
    code, travel = judging.hexadecimal(data[:2], 2), judging.hexadecimal(data[18:22], 4)
    pulses = judging.hexadecimal(data[22:], 8)
    model = MODELS.get(code) or Model(f"ELL{code}", "rotary" if pulses > _FEWEST_A_TURN else "linear")
    counted = pulses or (model.travels == "positions" and travel)  # those of sliders give no pulses
    if not counted or not data[2:10].isalnum() or not data[10:16].isalnum():
        raise ValueError(f"{data!r} has no pulses, or no serial number")
    who = Identity(vendor="Thorlabs", model=model.name, serial=data[2:10], firmware=f"0x{data[14:16]}")
    return About(model, pulses, travel), who


def address_of(entry: DeviceEntry) -> str:
    """Return the address of a device on its line."""
    return str(entry.address.get("bus", "0")).upper()


def complaints_of(travels: str) -> Callable[[DeviceEntry], Iterator[Complaint]]:
    """Return what tells of an address that is none, and of a model that does not move as the driver takes it to."""

    def found(entry: DeviceEntry) -> Iterator[Complaint]:
        if not re.fullmatch("[0-9A-F]", address_of(entry)):
            yield Complaint("address.bus", f"`{entry.address['bus']}` is no address on the line", "it is `0` to `F`")
        for model in MODELS.values():
            if model.name == entry.identity.get("model", "").upper() and model.travels != travels:
                hint = f"write `driver: {_OF_TRAVEL[model.travels]}`"
                yield Complaint("driver", f"an {model.name} is not {_DOES[travels]}", hint)

    return found


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
    line = _line_of(bus)
    line.timeout = within
    said = line.read_until(_END)
    if said and not said.endswith(_END):
        line.timeout = _REPLY
        said += line.read_until(_END)
    found = _REPLY_LINE.fullmatch(said)
    if found is None:
        return None
    from ElliptecBus.elliptec_bus import Packet

    address, command, data = (one.decode() for one in found.groups())
    return Packet(said[:-2].decode(), address, command, data)


def _hex(pulses: float) -> str:
    return f"{round(pulses) & 0xFFFFFFFF:08X}"


def series_driver(made: type[Device], **more: Any) -> Driver:
    """Return the driver of devices of the series; `more`: what it declares besides address and link."""
    return Driver(
        made=made, opened=_opened, closed=lambda bus: bus.close(),
        address={"port": "the serial port (`/dev/ttyUSB0`)", "bus": "its address on the line, `0` to `F`"},
        bus=("port",), usual={"bus": "0"}, needs=("ElliptecBus.elliptec_bus", "thorlabs"), maturity="emulated",
        emulator="elliptec", link="elliptec", **more,
    )  # fmt: skip


def _driver(made: type[_Axis], bounds: dict[str, tuple[float, float]]) -> Driver:
    properties = {made.prop: made.unit}
    check = complaints_of(made.travels)
    return series_driver(made, kind="axis", properties=properties, bounds=bounds, settings={}, check=check)


ROTATOR = _driver(Rotator, {"angle": (0.0, 360.0)})
"""`elliptec.rotator`: ELL8, ELL14, ELL16, ELL18."""
STAGE = _driver(Stage, {})
"""`elliptec.stage`: ELL7, ELL10, ELL17, ELL20."""
