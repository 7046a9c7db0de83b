"""Numbers that an instrument reads in a unit, with sigma, and sets where it can: volts, temperatures, a lock-in."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from pico.diagnostics import PicoError, error
from pico.drivers.driven import UNKNOWN, WithoutAxis
from pico.drivers.protocols import Instrument, Readable
from pico.model.instruments.kind import InstrumentKind, Point
from pico.model.instruments.readout import Readout, shown
from pico.model.observation import ObservedValue
from pico.model.quantities import Value


class Number(Instrument, Readable, Protocol):
    """An instrument of one or more numbers, by the names of its driver's properties."""

    async def number(self, name: str) -> Readout:
        """Return what it reads of a property now, with its sigma if that is known; unknown with the reason. Raises
        PicoError if it can't be asked."""
        ...


@runtime_checkable
class SettableNumber(Protocol):
    """An instrument of numbers that can be set."""

    async def set_number(self, name: str, value: float) -> Readout:
        """Set a property, in its unit, and return what is read back once that has ended; raises PicoError beyond its
        limits, where it can't be set, and where that fails."""
        ...


class _Numbered(WithoutAxis):
    """A tunable that is a number of an instrument."""

    def __init__(self, point: Point) -> None:
        self.instrument, self._point = point.instrument, point

    async def read(self) -> ObservedValue:
        found = (await self.instrument.number(self._point.property)).number
        return UNKNOWN if found is None else ObservedValue(value=self._point.conversion.to_lab(found))

    async def set(self, value: Value) -> Value:
        name, conversion, address = self._point.property, self._point.conversion, self._point.address
        if not self._point.writable or not isinstance(self.instrument, SettableNumber):
            text = f"{address} can't be set: `{name}` of its device is only read"
            raise PicoError(error("read-only", text, hint="`set:` in its settings says how it is set", address=address))
        found = await self.instrument.set_number(name, conversion.to_device(float(value)))
        if (number := found.number) is None:
            text = f"{address} can't be read back: {found.why}"
            raise PicoError(error("device-reply", text, hint="`pico devices read` shows the reply", address=address))
        return conversion.to_lab(number)


class _Read:
    """A measurable that is a number of an instrument."""

    colored = False

    def __init__(self, point: Point) -> None:
        self._instrument, self._property = point.instrument, point.property

    async def read(self, wavelength: float | None = None) -> Readout:
        found: Readout = await self._instrument.number(self._property)
        return found


async def _reads(instrument: Number) -> str:
    found = await instrument.readouts()
    return ", ".join(f"{name} {shown(one)}" if len(found) > 1 else shown(one) for name, one in found.items())


KIND = InstrumentKind(
    name="number", about="numbers that are read in a unit, with sigma, and set where the driver can", protocol=Number,
    reads=_reads, by_name=True, datatypes=("float",),
    drives=lambda point: _Numbered(point) if point.tunable is not None else None, measures=_Read,
)  # fmt: skip
