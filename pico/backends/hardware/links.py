"""The links to a bench's instruments: opened when they are first needed, and shared by all who have the bench in this
process, for most instruments talk to one only."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

from pico.backends.hardware.instruments import Instruments, wired
from pico.backends.hardware.lights import Lights
from pico.backends.hardware.settings import Settings
from pico.backends.instruments import emulated
from pico.diagnostics import Diagnostic, PicoError
from pico.drivers.registry import Buses, known_driver
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.hardware.guard.note import Ended
    from pico.backends.hardware.guard.verdict import Trip
    from pico.emulators.registry import EmulatedBench
    from pico.vision.calibration import Calibration


class Emulated(Protocol):
    """The world behind emulators: its clock goes at `pace` times the wall's."""

    pace: float

    def now(self) -> float:
        """Return its clock [s]."""
        ...

    def store(self) -> None:
        """Keep it as it is."""
        ...

    def pull(self, device: str, pulled: bool) -> None:
        """Pull a safety input by the device that reads it, or put it back."""
        ...


BringUp = Callable[["Setup", BenchPlace, dict[str, DeviceEntry]], "tuple[Emulated, EmulatedBench]"]
"""Starts emulators of all devices of a lab, and gives them with the world behind."""
_open: dict[BenchPlace, Links] = {}


class Links:
    """The links of the bench at `place`; with `bring_up` they lead to emulators in this
    process, brought up when they are first needed."""

    def __init__(
        self, setup: Setup, place: BenchPlace, bring_up: BringUp | None = None, before: Links | None = None
    ) -> None:  # fmt: skip
        """`before`: whose links these replace."""
        self._before, self._bring_up = before, bring_up
        self.setup, self.place = setup, place
        self.world: Emulated | None = None
        self.emulators: EmulatedBench | None = None
        self._buses = Buses()
        self._instruments: Instruments | None = None
        self._made: Instruments | None = None
        self._about: Instruments | None = None
        self._lights: Lights | None = None
        self._heard: Callable[[Ended, Trip | None], None] | None = None
        self._disarm: Callable[[str], tuple[str, ...]] | None = None
        self._connecting = asyncio.Lock()

    @property
    def entries(self) -> dict[str, DeviceEntry]:
        """The devices of the lab."""
        return dict(self.setup.wiring.devices) if self.setup.wiring else {}

    def now(self) -> float:
        """Return the bench's clock [s]: of the wall, or of the emulated world."""
        return self.world.now() if self.world is not None else time.time()

    async def pause(self, seconds: float) -> None:
        """Wait so long by the bench's clock."""
        await asyncio.sleep(seconds / (self.world.pace if self.world is not None else 1.0))

    def about(self) -> Instruments:
        """Return the instruments of the lab's devices, none of them connected: what there is, without asking any."""
        if self._about is None:
            self._about = wired(self.setup, self.entries, Buses(), Settings(self.place), known=self._known())
        return self._about

    def arm_devices(self) -> dict[str, str]:
        """Return the device that moves each robot, by robot."""
        found = ((entry.of or name, name, known_driver(entry.driver)) for name, entry in self.entries.items())
        return {robot: name for robot, name, about in found if about and about.kind == "arm"}

    @property
    def connected(self) -> Instruments | None:
        """The instruments where they are connected, None where nobody has asked any yet."""
        return self._instruments

    async def instruments(self) -> Instruments:
        """Return the instruments, connected; raises PicoError for all that does not answer, or is another one."""
        async with self._connecting:
            if self._instruments is None:
                if self._before is not None:
                    await self._before.close()
                found = self._wired()
                await found.connect()
                self._instruments = found
                self.lights().watch()
            return self._instruments

    def _wired(self) -> Instruments:
        """Return the instruments over the links of this bench, connected or not."""
        if self._made is None:
            reached = self._reached()
            self._made = wired(self.setup, reached, self._buses, Settings(self.place), self._failed(), self._known())
        return self._made

    def _known(self) -> Calibration | None:
        """Return the calibration of the bench, None if the bench refuses it: whoever moves or looks says so."""
        from pico.vision.calibration_files import read_calibration

        with suppress(PicoError):
            return read_calibration(self.place.root, self.place.name)
        return None

    def lights(self) -> Lights:
        """Return what ends light here; it needs no other device to answer. Raises PicoError for devices that can't be
        had at all."""
        if self._lights is None:
            self._lights = Lights(self.setup, self.place, self._wired())
            self._lights.listening, self._lights.disarming = self._heard, self._disarm
        return self._lights

    def listen(
        self, heard: Callable[[Ended, Trip | None], None], disarm: Callable[[str], tuple[str, ...]] | None = None
    ) -> None:
        """Have `heard` called, in any thread, after light was ended, and `disarm` if armings end with it."""
        self._heard, self._disarm = heard, disarm
        if self._lights is not None:
            self._lights.listening, self._lights.disarming = heard, disarm

    async def reached(self) -> dict[str, DeviceEntry]:
        """Connect, and return the devices with the addresses that lead to them; raises PicoError as `instruments`."""
        await self.instruments()
        return self._reached()

    def _reached(self) -> dict[str, DeviceEntry]:
        if self._bring_up is None:
            return self.entries
        if self.emulators is None:
            self.world, self.emulators = self._bring_up(self.setup, self.place, emulated(self.entries))
        return {**self.entries, **self.emulators.entries}

    def _failed(self) -> Mapping[str, Sequence[Diagnostic]]:
        """Return why devices have no emulator, by device."""
        return self.emulators.failed if self.emulators is not None else {}

    async def close(self) -> None:
        """Let go of every link, and end what emulates."""
        if _open.get(self.place) is self:
            del _open[self.place]
        found, self._instruments, self._made = self._made, None, None
        lights, self._lights = self._lights, None
        if lights is not None:
            await asyncio.to_thread(lights.close)
        if found is not None:
            await asyncio.gather(*(one.close() for one in found.all.values()), return_exceptions=True)
        await self._buses.close()
        if self.emulators is not None:
            self.emulators.close()
        if self.world is not None:
            self.world.store()
        self.emulators = self.world = None


def links(setup: Setup, place: BenchPlace, bring_up: BringUp | None = None) -> Links:
    """Return the links of a bench: those that are open in this process, where they lead to the same devices."""
    key = replace(place, root=place.root.resolve())
    known = _open.get(key)
    if known is not None and known.setup.wiring == setup.wiring and known.setup.at_speed(1.0) == setup.at_speed(1.0):
        return known
    _open[key] = Links(setup, key, bring_up, known)
    return _open[key]
