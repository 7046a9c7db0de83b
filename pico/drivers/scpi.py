"""Instruments that speak SCPI: power meters, lasers whose output is switched by `OUTP`, contacts and relays."""

from __future__ import annotations

import time

from pico.diagnostics import PicoError
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity, SafetyState
from pico.drivers.visa import ADDRESS, Visa, require_read_back
from pico.model.wiring import DeviceEntry

_WAVELENGTH = 0.5
"""How far the wavelength that is read back may be from what was set [nm]."""
_NEEDS = ("pyvisa_py", "scpi")


class Spoken:
    """What all of them have in common. It does not move: a stop has nothing to do but for what lets light out."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        self.name, self._entry = name, entry
        self._line = Line(name, bus, entry.identity, Visa.identity)

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def stop(self) -> None:
        """Nothing moves here."""

    async def close(self) -> None:
        await self._line.close()


class PowerMeter(Spoken):
    """A power meter that knows `MEAS:POW?` and `SENS:CORR:WAV`."""

    async def power(self, *, wavelength: float | None = None) -> tuple[float, float | None]:
        """Return the power [W]; how uncertain it is the meter does not say. `wavelength` [nm] is set, and read back."""

        def read(visa: Visa) -> float:
            if wavelength is not None:
                visa.tell(f"SENS:CORR:WAV {wavelength:.3f}")
                found = visa.number("SENS:CORR:WAV?")
                if abs(found - wavelength) > _WAVELENGTH:
                    require_read_back(self.name, "the wavelength [nm]", wavelength, found)
            return visa.number("MEAS:POW?")

        if wavelength is not None and (limits := self._entry.limits.get("wavelength")):
            require_within(self.name, "wavelength", wavelength, limits, "nm")
        return await self._line.ask("read the power", read, within=4.0), None


class Laser(Spoken):
    """A laser that is switched by `OUTP`, and says by `OUTP?` whether it emits."""

    async def emit(self, on: bool) -> bool:
        """Switch it, and return whether it emits as it says itself; raises PicoError where that is not as wanted."""

        def switch(visa: Visa) -> bool:
            visa.tell(f"OUTP {'ON' if on else 'OFF'}")
            return _yes(visa.ask("OUTP?"))

        ask = self._line.move if on else self._line.ask
        found = await ask("emit" if on else "stop emitting", switch)
        require_read_back(self.name, "emission", on, found)
        return found

    async def emitting(self) -> bool | None:
        return await self._line.ask("tell whether it emits", lambda visa: _yes(visa.ask("OUTP?")))

    async def stop(self) -> None:
        """Switch it off, before all else."""
        await self._line.stop(lambda visa: visa.tell("OUTP OFF"))


class SafetyInput(Spoken):
    """A contact: closed, with current through it, where all is safe; a cut wire is an open one. Each answer counts on,
    so that an answer twice is no answer. What is not heard, is late or makes no sense is unknown: unsafe."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        super().__init__(name, entry, bus)
        self._count = -1
        self._heard = float("-inf")

    async def read(self) -> SafetyState:
        try:
            safe = await self._line.ask("tell its contact", self._contact, within=1.5)
        except PicoError:
            safe = None
        if safe is not None:
            self._heard = time.monotonic()
        return SafetyState(safe=safe, age=time.monotonic() - self._heard)

    def _contact(self, visa: Visa) -> bool | None:
        closed, count = contact(visa, self._entry)
        fresh, self._count = count != self._count, count
        return closed if fresh else None


class Shutter(Spoken):
    """A shutter at a relay; whether it is open a contact of its own says, closed while the shutter is."""

    async def open(self, wanted: bool) -> bool:
        """Switch the relay, and return what the sensor says then; raises PicoError where that is not as wanted."""

        def switch(visa: Visa) -> bool:
            visa.tell(f"OUTP {'ON' if wanted else 'OFF'},(@{self._entry.address['relay']})")
            ends = time.monotonic() + 0.5
            while (is_open := not contact(visa, self._entry)[0]) != wanted and time.monotonic() < ends:
                time.sleep(0.01)
            return is_open

        ask = self._line.move if wanted else self._line.ask
        found = await ask("open" if wanted else "close", switch, within=3.0)
        require_read_back(self.name, "open", wanted, found)
        return found

    async def is_open(self) -> bool | None:
        return await self._line.ask("tell its sensor", lambda visa: not contact(visa, self._entry)[0])

    async def stop(self) -> None:
        """Close it, before all else."""
        await self._line.stop(lambda visa: visa.tell(f"OUTP OFF,(@{self._entry.address['relay']})"))


class Lamp(Spoken):
    """A lamp at a relay."""

    async def shine(self, on: bool) -> bool:
        command = f"OUTP {'ON' if on else 'OFF'},(@{self._entry.address['relay']})"
        await self._line.ask("switch the lamp", lambda visa: visa.told(command))
        return on


def contact(visa: Visa, entry: DeviceEntry) -> tuple[bool, int]:
    """Return whether the contact of an entry is closed, and the count of the answer; raises ValueError."""
    closed, _, count = visa.ask(f"INP? (@{entry.address['channel']})").partition(",")
    return _yes(closed), int(count)


def _yes(said: str) -> bool:
    if said not in ("0", "1"):
        raise ValueError(f"{said[:40]!r} is neither 0 nor 1")
    return said == "1"


_CONTACTS = {
    **ADDRESS, "channel": "the number of its contact", "relay": "the number of its relay",
}  # fmt: skip
METER = Driver(
    kind="power meter", made=PowerMeter, opened=Visa, closed=Visa.close, address=ADDRESS, bus=("visa",),
    properties={"power": "W", "wavelength": "nm"}, needs=_NEEDS, maturity="emulated", emulator="scpi.meter",
)  # fmt: skip
LASER = Driver(
    kind="laser", made=Laser, opened=Visa, closed=Visa.close, address=ADDRESS, bus=("visa",),
    properties={"emission": ""}, needs=_NEEDS, maturity="emulated", emulator="scpi.laser",
)  # fmt: skip
SAFETY = Driver(
    kind="safety input", made=SafetyInput, opened=Visa, closed=Visa.close, address=_CONTACTS, bus=("visa",),
    needs=_NEEDS, maturity="emulated", emulator="scpi.contacts", link="scpi.contacts",
)  # fmt: skip
SHUTTER = Driver(
    kind="shutter", made=Shutter, opened=Visa, closed=Visa.close, address=_CONTACTS, bus=("visa",),
    properties={"open": ""}, needs=_NEEDS, maturity="emulated", emulator="scpi.contacts", link="scpi.contacts",
)  # fmt: skip
LAMP = Driver(
    kind="lamp", made=Lamp, opened=Visa, closed=Visa.close, address=_CONTACTS, bus=("visa",),
    properties={"on": ""}, needs=_NEEDS, maturity="emulated", emulator="scpi.contacts", link="scpi.contacts",
)  # fmt: skip
