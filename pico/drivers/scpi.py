"""Instruments that speak SCPI: power meters, lasers whose output is switched by `OUTP`, contacts and relays."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Protocol

from pico.diagnostics import PicoError
from pico.drivers import judging
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity, SafetyState
from pico.drivers.visa import ADDRESS, SETTINGS, Visa, complaints, require_read_back, wire_of, within_of
from pico.model.instruments.declaration import Setting
from pico.model.instruments.readout import Readout, unknown
from pico.model.quantities import Value
from pico.model.wiring import DeviceEntry

_WAVELENGTH = "SENS:CORR:WAV?"
_NEEDS = ("pyvisa_py", "scpi")


class Spoken:
    """What all of them have in common. It does not move: a stop has nothing to do but for what lets light out."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        self.name, self._entry = name, entry
        self._line = Line(name, bus, entry.identity, Visa.identity)

    @property
    def _within(self) -> float:
        """How long two questions may take [s]."""
        return within_of(self._entry)

    async def connect(self) -> Identity:
        return await self._line.connect(within=self._within)

    async def stop(self) -> None:
        """Nothing moves here."""

    async def close(self) -> None:
        await self._line.close()


class PowerMeter(Spoken):
    """A power meter that knows `MEAS:POW?` and `SENS:CORR:WAV`."""

    async def power(self, *, wavelength: float | None = None) -> Readout:
        """Return the power [W]; the meter does not say how uncertain it is. `wavelength` [nm] is set first, and what is
        read back of it is in the `settings` of the readout."""

        def read(visa: Visa) -> Readout:
            return metered(visa, self._entry, wavelength)

        require_told(self.name, self._entry, wavelength)
        return await self._line.ask("read the power", read, within=self._within)

    async def wavelength(self) -> Readout:
        """Return the wavelength [nm] for which the reading is corrected."""
        return await self._line.ask(
            "tell its wavelength", lambda visa: judging.number(visa.ask(_WAVELENGTH), "nm"), within=self._within
        )

    async def set_wavelength(self, wavelength: float) -> Readout:
        """Set the wavelength [nm] for which the reading is corrected, and return what is read back."""
        require_told(self.name, self._entry, wavelength)
        return await self._line.ask(
            "set its wavelength", lambda visa: corrected(visa, self._entry, wavelength), within=self._within
        )

    async def readouts(self) -> Mapping[str, Readout]:
        """Return what it reads of its properties, with the replies."""
        return {"power": await self.power(), "wavelength": await self.wavelength()}


def require_told(name: str, entry: DeviceEntry, wavelength: float | None) -> None:
    """Raise PicoError for a wavelength [nm] beyond the limits of a meter."""
    if wavelength is not None and (limits := entry.limits.get("wavelength")):
        require_within(name, "wavelength", wavelength, limits, "nm")


class Questions(Protocol):
    """A link over which a meter is asked."""

    def ask(self, question: str) -> str: ...

    def ask_if_known(self, question: str) -> str | None: ...

    def tell(self, command: str) -> None: ...

    def failure(self, *, after_reply: bool = False) -> str: ...


def metered(link: Questions, entry: DeviceEntry, wavelength: float | None) -> Readout:
    """Return the power [W] that a meter reads, corrected for `wavelength` [nm] if it takes that; raises what the link
    raises, and ValueError for an error queue that can't be read."""
    settings: dict[str, Value] = {}
    if wavelength is not None and entry.settings.get("wavelength", True):
        found = corrected(link, entry, wavelength)
        if found.value is None:
            return unknown("W", "wavelength", found.raw, f"its wavelength can't be read: {found.why}")
        settings["wavelength"] = found.value
    if (said := _not_in_watts(link, entry)) is not None:
        text = f"the meter is to read in W, and says of its unit: {said[:20]!r}"
        return unknown("W", "garbled", said, text)
    raw = link.ask("MEAS:POW?")
    try:
        queued = link.failure(after_reply=True) if entry.settings.get("error_queue", True) else ""
    except ValueError as exc:
        return unknown("W", "garbled", raw, f"its error queue can't be read: {exc}")
    found = judging.number(raw, "W", limits=entry.limits.get("power"), failure=queued)
    if found.number is not None and found.number < -NOISE:
        text = f"a power of {found.number:g} W is below the noise of a meter: adjust its zero, and set it to W"
        found = unknown("W", "under-range", raw, text)
    return replace(found, settings=settings)


NOISE = 1e-4
"""What a meter may read below zero in the dark [W]."""
_UNIT = "SENS:POW:UNIT"


def _not_in_watts(link: Questions, entry: DeviceEntry) -> str | None:
    """Set a meter that was set to dBm to W, and return what it says of its unit then; None if that is W, as it is of a
    meter that does not know the question."""
    if not entry.settings.get("power_unit", True):
        return None
    said = link.ask_if_known(f"{_UNIT}?")
    if said is None:
        if entry.settings.get("error_queue", True):
            link.failure()  # a meter without this command queues an error, which does not concern the reading
        return None
    if said.strip().upper() == "DBM":
        link.tell(f"{_UNIT} W")
        said = link.ask(f"{_UNIT}?")
    return None if said.strip().upper() == "W" else said


def corrected(link: Questions, entry: DeviceEntry, wavelength: float) -> Readout:
    """Set the wavelength [nm] of a meter, and return what it reads back."""
    link.tell(f"{_WAVELENGTH[:-1]} {wavelength:.3f}")
    found = judging.number(link.ask(_WAVELENGTH), "nm")
    if entry.settings.get("error_queue", True) and not judging.same_wavelength(found.value, wavelength):
        link.failure()  # that it was refused is what was read back: it is no error of the reading
    return found


class Laser(Spoken):
    """A laser that is switched by `OUTP`, and says by `OUTP?` whether it emits."""

    async def emit(self, on: bool) -> bool:
        """Switch it, and return whether it emits as it says itself; raises PicoError where that is not as wanted."""

        def switch(visa: Visa) -> bool:
            visa.tell(f"OUTP {'ON' if on else 'OFF'}")
            return judging.switched(visa.ask("OUTP?"))

        ask = self._line.move if on else self._line.end
        found = await ask("emit" if on else "stop emitting", switch, within=self._within)
        require_read_back(self.name, "emission", on, found)
        return found

    async def emitting(self) -> bool | None:
        return await self._line.ask(
            "tell whether it emits", lambda visa: judging.switched(visa.ask("OUTP?")), within=self._within
        )

    async def readouts(self) -> Mapping[str, Readout]:
        """Return what it reads of its properties, with the replies."""
        ask = self._line.ask
        return {"emission": await ask("tell whether it emits", lambda visa: judging.switch(visa.ask("OUTP?")))}

    async def stop(self) -> None:
        """Switch it off, before all else."""
        await self._line.stop(lambda visa: visa.tell("OUTP OFF"))


class SafetyInput(Spoken):
    """A contact: closed, with current through it, where all is safe; a cut wire is an open one. Each answer counts on,
    so that an answer twice is no answer. What is not heard, is late or makes no sense is unknown: unsafe."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        super().__init__(name, entry, bus)
        self._contact = Contact(entry)
        self._heard = float("-inf")

    async def read(self) -> SafetyState:
        try:
            safe = await self._line.ask("tell its contact", self._contact.closed, within=1.5)
        except PicoError:
            safe = None
        if safe is not None:
            self._heard = time.monotonic()
        return SafetyState(safe=safe, age=time.monotonic() - self._heard)


class Shutter(Spoken):
    """A shutter at a relay; whether it is open a contact of its own says, closed while the shutter is."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Visa]) -> None:
        super().__init__(name, entry, bus)
        self._contact = Contact(entry)

    async def open(self, wanted: bool) -> bool:
        """Switch the relay, and return what the sensor says then; raises PicoError where that is not as wanted."""

        def switch(visa: Visa) -> bool:
            visa.tell(f"OUTP {'ON' if wanted else 'OFF'},(@{self._entry.address['relay']})")
            ends = time.monotonic() + 0.5
            while (is_open := self._sensed(visa)) != wanted and time.monotonic() < ends:
                time.sleep(0.01)
            if is_open is None:
                raise ValueError("the sensor of the shutter repeats an earlier answer")
            return is_open

        ask = self._line.move if wanted else self._line.end
        found = await ask("open" if wanted else "close", switch, within=3.0)
        require_read_back(self.name, "open", wanted, found)
        return found

    async def is_open(self) -> bool | None:
        return await self._line.ask("tell its sensor", self._sensed)

    def _sensed(self, visa: Visa) -> bool | None:
        closed = self._contact.closed(visa)
        return None if closed is None else not closed

    async def stop(self) -> None:
        """Close it, before all else."""
        await self._line.stop(lambda visa: visa.tell(f"OUTP OFF,(@{self._entry.address['relay']})"))


class Lamp(Spoken):
    """A lamp at a relay."""

    async def shine(self, on: bool) -> bool:
        command = f"OUTP {'ON' if on else 'OFF'},(@{self._entry.address['relay']})"
        await self._line.ask("switch the lamp", lambda visa: visa.told(command))
        return on


class Contact:
    """A contact of a box whose answers count on, so that an earlier answer is known as one."""

    def __init__(self, entry: DeviceEntry) -> None:
        self._channel, self._count = entry.address["channel"], -1

    def closed(self, visa: Visa) -> bool | None:
        """Return whether it is closed; None if the count is not above that of the answer before (a box that was
        switched on anew counts from the start, and is believed from its second answer on). Raises ValueError."""
        closed, _, said = visa.ask(f"INP? (@{self._channel})").partition(",")
        count = judging.whole(said)
        newer, self._count = count > self._count, count
        return judging.switched(closed) if newer else None


_CONTACTS = {
    **ADDRESS, "channel": "the number of its contact", "relay": "the number of its relay",
}  # fmt: skip
_CONTACT_NUMBERS = {"channel": (0, 9999), "relay": (0, 9999)}
METER_SETTINGS = {
    **SETTINGS,
    "wavelength": Setting(kind=bool, default=True, about="whether it knows `SENS:CORR:WAV`, to be told the light's"),
    "power_unit": Setting(kind=bool, default=True, about="whether it knows `SENS:POW:UNIT?`, to be set to W"),
    "error_queue": Setting(kind=bool, default=True, about="whether it knows `SYST:ERR?`, asked after each reading"),
}
METER = Driver(
    kind="power meter", made=PowerMeter, opened=Visa, closed=Visa.close, address=ADDRESS, bus=("visa",),
    settings=METER_SETTINGS, wire=wire_of, check=complaints,
    properties={"power": "W", "wavelength": "nm"}, needs=_NEEDS, maturity="emulated", emulator="scpi.meter",
)  # fmt: skip
LASER = Driver(
    kind="laser", made=Laser, opened=Visa, closed=Visa.close, address=ADDRESS, bus=("visa",),
    settings=SETTINGS, wire=wire_of, check=complaints,
    properties={"emission": ""}, needs=_NEEDS, maturity="emulated", emulator="scpi.laser",
)  # fmt: skip
SAFETY = Driver(
    kind="safety input", made=SafetyInput, opened=Visa, closed=Visa.close, address=_CONTACTS, bus=("visa",),
    required=("channel",), numbers=_CONTACT_NUMBERS,
    settings=SETTINGS, wire=wire_of, check=complaints, one_identity=True,
    needs=_NEEDS, maturity="emulated", emulator="scpi.contacts", link="scpi.contacts",
)  # fmt: skip
SHUTTER = Driver(
    kind="shutter", made=Shutter, opened=Visa, closed=Visa.close, address=_CONTACTS, bus=("visa",),
    required=("channel", "relay"), numbers=_CONTACT_NUMBERS,
    settings=SETTINGS, wire=wire_of, check=complaints, one_identity=True,
    properties={"open": ""}, needs=_NEEDS, maturity="emulated", emulator="scpi.contacts", link="scpi.contacts",
)  # fmt: skip
LAMP = Driver(
    kind="lamp", made=Lamp, opened=Visa, closed=Visa.close, address=_CONTACTS, bus=("visa",),
    required=("relay",), numbers=_CONTACT_NUMBERS,
    settings=SETTINGS, wire=wire_of, check=complaints, one_identity=True,
    properties={"on": ""}, needs=_NEEDS, maturity="emulated", emulator="scpi.contacts", link="scpi.contacts",
)  # fmt: skip
