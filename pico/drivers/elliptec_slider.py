"""Thorlabs Elliptec sliders, ELL6 of two positions, ELL9 of four and ELL12 of six: named positions on the same serial
line as the mounts and stages of `pico.drivers.elliptec`.

The positions are evenly spread over the travel that the device gives of itself; sensors keep them, so that nothing has
to be homed.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from pico.diagnostics import PicoError, did_you_mean, error
from pico.drivers import judging
from pico.drivers.bus import Bus
from pico.drivers.elliptec import Device, complaints_of, series_driver
from pico.drivers.protocols import Identity
from pico.model.instruments.complaint import Complaint
from pico.model.instruments.declaration import Setting
from pico.model.instruments.readout import Readout, unknown
from pico.model.wiring import DeviceEntry

if TYPE_CHECKING:
    from ElliptecBus.elliptec_bus import ElliptecBus

POSITIONS = {"ELL6": 2, "ELL9": 4, "ELL12": 6}
"""How many positions a model has."""
OFF = 2
"""How far from a position a slider may read and be there nevertheless [mm]."""


class Slider(Device):
    """A slider: a `Choice`."""

    travels, unit, reached = "positions", "mm", float(OFF)

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[ElliptecBus]) -> None:
        super().__init__(name, entry, bus)
        self._names = names_of(entry)
        self._goal: str | None = None

    async def choices(self) -> Sequence[str]:
        return tuple(self._names.values())

    async def position(self) -> Readout:
        """Return at which position it is; unknown while it moves, and between two of them."""

        def read(bus: ElliptecBus) -> Readout:
            packet = self._asked(bus, "gp", "PO")
            at = judging.hexadecimal(packet.data, 8, signed=True)
            found = next((name for name in self._names.values() if abs(self._place(name) - at) <= OFF), None)
            if found is None:
                return unknown("", "moving", packet.raw, f"{at} mm is none of its positions")
            return Readout(unit="", value=found, raw=packet.raw)

        found = await self._line.ask("tell its position", read)
        if self._goal is None or found.value == self._goal:
            return found
        return unknown("", "moving", found.raw, f"it moves to {self._goal}")

    async def move_to(self, name: str) -> str:
        if name not in self._names.values():
            text, hint = f"{self.name} has no position `{name[:40]}`", did_you_mean(name[:40], self._names.values())
            raise PicoError(error("device-limit", text, hint=hint, address=self.name))
        stops, self._goal = self._line.stops, name
        try:
            for step in await self._way(name):
                self._line.require_running(stops, f"move to {name}")
                await self._stepped(name, step)
        finally:
            self._goal = None
        return name

    async def _way(self, name: str) -> list[tuple[str, int]]:
        """Return the steps from where it is to a position: in which direction, and to which place [mm]."""
        at = await self._line.ask("tell its position", lambda bus: int(self._position(self._asked(bus, "gp", "PO"))))
        places, goal = self._places(), self._place(name)
        ahead = [("fw", place) for place in places if at + OFF < place <= goal]
        return ahead or [("bw", place) for place in reversed(places) if at - OFF > place >= goal]

    async def _stepped(self, name: str, step: tuple[str, int]) -> None:
        command, place = step
        at = await self._moved(f"move to {name}", lambda: place, command)
        if abs(at - place) > OFF:
            text = f"{self.name} came to rest at {at:g} mm on its way to {name}, and was to be at {place} mm"
            raise PicoError(error("device-missed", text, address=self.name))

    async def readouts(self) -> Mapping[str, Readout]:
        return {"position": await self.position()}

    def _places(self) -> list[int]:
        """Return where its positions are, as the device counts [mm]."""
        count = POSITIONS[self._about.model.name]
        return [round(n * self._about.travel / (count - 1)) for n in range(count)]

    def _place(self, name: str) -> int:
        return self._places()[next(int(key) for key, one in self._names.items() if one == name) - 1]

    def _of(self, pulses: int) -> float:
        return float(pulses)

    def _identity(self, bus: ElliptecBus) -> Identity:
        who = super()._identity(bus)
        count = POSITIONS.get(who.model, 0)
        if beyond := [key for key in self._names if int(key) > count]:
            text = f"{self.name} is an {who.model}, which has {count} positions, and the lab names {', '.join(beyond)}"
            raise PicoError(error("device-kind", text, hint="delete them from `positions`", address=self.name))
        return who


def names_of(entry: DeviceEntry) -> dict[str, str]:
    """Return the names of the positions by their numbers, from 1 on."""
    said = entry.settings.get("positions")
    return {str(key): str(name) for key, name in said.items()} if isinstance(said, Mapping) else {}


def _complaints(entry: DeviceEntry) -> Iterator[Complaint]:
    yield from complaints_of("positions")(entry)
    names = names_of(entry)
    most = POSITIONS.get(entry.identity.get("model", "").upper(), max(POSITIONS.values()))
    for key in names:
        if not key.isdecimal() or not 1 <= int(key) <= most:
            text = f"`{key[:40]}` is not the number of a position, 1 to {most}"
            yield Complaint("settings.positions", text, "`positions: {1: open, 2: nd1}`")
    if "positions" in entry.settings and (len(names) < 2 or len(set(names.values())) < len(names)):
        yield Complaint("settings.positions", "`positions` are two different names at least", "")


SLIDER = series_driver(
    Slider, kind="choice", properties={"position": ""}, check=_complaints,
    settings={"positions": Setting(kind=dict, about="the names of its positions by their numbers, from 1 on")},
)  # fmt: skip
"""`elliptec.slider`: ELL6, ELL9, ELL12."""
