"""Power meters of Thorlabs (PM100 and its kin) through PyMeasure's driver, which clips a wavelength without a word: it
is read back."""

from __future__ import annotations

import warnings
from typing import Any

from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.limits import require_within
from pico.drivers.line import Line
from pico.drivers.protocols import Identity
from pico.drivers.visa import ADDRESS, REPLY, identity_of, require_read_back
from pico.model.wiring import DeviceEntry

_WAVELENGTH = 0.5
"""How far the wavelength that is read back may be from what was set [nm]."""


def _opened(entry: DeviceEntry) -> Any:
    from pymeasure.adapters import VISAAdapter
    from pymeasure.instruments.thorlabs import ThorlabsPM100USB

    milliseconds = round(REPLY * 1000)
    adapter = VISAAdapter(
        str(entry.address["visa"]), visa_library="@py", timeout=milliseconds, open_timeout=milliseconds,
        read_termination="\n", write_termination="\n",
    )  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)  # PyMeasure asks whether the device speaks SCPI
        return ThorlabsPM100USB(adapter)


class PM100:
    """A power meter."""

    def __init__(self, name: str, entry: DeviceEntry, bus: Bus[Any]) -> None:
        self.name, self._limits = name, entry.limits.get("wavelength", (0.0, 1e6))
        self._line = Line(name, bus, entry.identity, lambda meter: identity_of(meter.ask("*IDN?").strip()))

    async def connect(self) -> Identity:
        return await self._line.connect()

    async def power(self, *, wavelength: float | None = None) -> tuple[float, float | None]:
        """Return the power [W]; `wavelength` [nm] is set first, and read back."""

        def read(meter: Any) -> float:
            meter.adapter.flush_read_buffer()
            if wavelength is not None:
                meter.wavelength = wavelength
                if abs((found := float(meter.wavelength)) - wavelength) > _WAVELENGTH:
                    require_read_back(self.name, "the wavelength [nm]", wavelength, found)
            return float(meter.power)

        if wavelength is not None:
            require_within(self.name, "wavelength", wavelength, self._limits, "nm")
        return await self._line.ask("read the power", read, within=4.0), None

    async def stop(self) -> None:
        """Nothing moves here."""

    async def close(self) -> None:
        await self._line.close()


METER = Driver(
    kind="power meter", made=PM100, opened=_opened, closed=lambda meter: meter.adapter.close(), address=ADDRESS,
    bus=("visa",), properties={"power": "W", "wavelength": "nm"}, needs=("pymeasure.instruments.thorlabs", "pymeasure"),
    maturity="emulated", emulator="scpi.meter",
)  # fmt: skip
