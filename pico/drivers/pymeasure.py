"""Power meters of Thorlabs (PM100 and its kin) through PyMeasure's driver. Replies are judged as they came: PyMeasure
clips a wavelength without a word, and takes any text for a reading."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

from pico.drivers import judging
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.drivers.scpi import METER_SETTINGS, corrected, metered, require_told
from pico.drivers.visa import (
    ADDRESS,
    ask_if_known,
    backend_of,
    complaints,
    queue_of,
    resource_options,
    wire_of,
    within_of,
)
from pico.model.instruments.readout import Readout
from pico.model.wiring import DeviceEntry


class _Link:
    """PyMeasure's instrument, asked line by line."""

    def __init__(self, entry: DeviceEntry) -> None:
        from pymeasure.adapters import VISAAdapter
        from pymeasure.instruments.thorlabs import ThorlabsPM100USB

        adapter = VISAAdapter(str(entry.address["visa"]), visa_library=backend_of(entry), **resource_options(entry))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FutureWarning)  # PyMeasure asks whether the device speaks SCPI
            self.meter: Any = ThorlabsPM100USB(adapter)

    def ask(self, question: str) -> str:
        """Return the reply to a question; what came before it is none."""
        self.meter.adapter.flush_read_buffer()
        return str(self.meter.ask(question)).strip()

    def ask_if_known(self, question: str) -> str | None:
        """Return the reply to a question, None if the instrument does not know it."""
        return ask_if_known(self.meter.adapter.connection, self.ask, question)

    def tell(self, command: str) -> None:
        """Send a command that has no reply."""
        self.meter.write(command)

    def failure(self, *, after_reply: bool = False) -> str:
        """Return the oldest entry of the error queue, and empty it; `after_reply`: see `pico.drivers.visa.Visa`."""
        return queue_of(self.ask, self._ask_at_once if after_reply else None)

    def _ask_at_once(self, question: str) -> str:
        said = str(self.meter.ask(question)).strip()
        return said or str(self.meter.read()).strip()

    def identity(self) -> Identity:
        """Return who answers to `*IDN?`."""
        return judging.identity(self.ask("*IDN?"))

    def close(self) -> None:
        """Close it."""
        self.meter.adapter.close()


class PM100:
    """A power meter."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[_Link]) -> None:
        self.name, self._entry = name, entry
        self._line = Line(name, bus, entry.identity, _Link.identity)

    async def connect(self) -> Identity:
        return await self._line.connect(within=within_of(self._entry))

    async def power(self, *, wavelength: float | None = None) -> Readout:
        """Return the power [W]; `wavelength` [nm] is set first, and what is read back of it is in its `settings`."""
        require_told(self.name, self._entry, wavelength)
        within = within_of(self._entry)
        return await self._line.ask(
            "read the power", lambda link: metered(link, self._entry, wavelength), within=within
        )

    async def wavelength(self) -> Readout:
        """Return the wavelength [nm] for which the reading is corrected."""
        return await self._line.ask(
            "tell its wavelength", lambda link: judging.number(link.ask("SENS:CORR:WAV?"), "nm")
        )

    async def set_wavelength(self, wavelength: float) -> Readout:
        """Set the wavelength [nm] for which the reading is corrected, and return what is read back."""
        require_told(self.name, self._entry, wavelength)
        return await self._line.ask("set its wavelength", lambda link: corrected(link, self._entry, wavelength))

    async def readouts(self) -> Mapping[str, Readout]:
        """Return what it reads of its properties, with the replies."""
        return {"power": await self.power(), "wavelength": await self.wavelength()}

    async def stop(self) -> None:
        """Nothing moves here."""

    async def close(self) -> None:
        await self._line.close()


METER = Driver(
    kind="power meter", made=PM100, opened=_Link, closed=_Link.close, address=ADDRESS, bus=("visa",),
    settings=METER_SETTINGS, wire=wire_of, check=complaints,
    properties={"power": "W", "wavelength": "nm"}, needs=("pymeasure.instruments.thorlabs", "pymeasure"),
    maturity="emulated", emulator="scpi.meter",
)  # fmt: skip
