"""Choices: named positions, of which a device has one at a time: filter wheels, sliders, gains, choppers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from pico.diagnostics import PicoError, did_you_mean, error
from pico.drivers.driven import UNKNOWN, WithoutAxis
from pico.drivers.protocols import Instrument
from pico.model.instruments.kind import InstrumentKind, Point, value_at
from pico.model.instruments.readout import Readout, shown
from pico.model.observation import ObservedValue
from pico.model.quantities import Value


class Choice(Instrument, Protocol):
    """A device of named positions."""

    async def choices(self) -> Sequence[str]:
        """Return the names of its positions, in their order; asks nothing that moves."""
        ...

    async def position(self) -> Readout:
        """Return the name of the position that it is at, unknown (`moving`) in between. Raises PicoError if it can't
        be asked."""
        ...

    async def move_to(self, name: str) -> str:
        """Move to a position, and return the one that is read once it is at rest; raises PicoError for a name that it
        does not have, and if it does not arrive in time."""
        ...


class _Chosen(WithoutAxis):
    """A tunable that is the position of a device. One of datatype bool has positions `on` and `off`, one of datatype
    float has numbers for names."""

    moves = True

    def __init__(self, point: Point) -> None:
        self.instrument, self._tunable, self._address = point.instrument, point.tunable, point.address

    async def read(self) -> ObservedValue:
        found = (await self.instrument.position()).value
        value = None if found is None else value_at(self._tunable, str(found))
        return UNKNOWN if value is None else ObservedValue(value=value)

    async def set(self, value: Value) -> Value:
        names = await self.instrument.choices()
        name = next((one for one in names if value_at(self._tunable, one) == value), None)
        if name is None:
            hint = did_you_mean(str(value)[:40], names) or f"its positions: {', '.join(names)}"
            text = f"{self._address} has no position `{str(value)[:40]}`"
            raise PicoError(error("device-limit", text, hint=hint, address=self._address))
        at = await self.instrument.move_to(name)
        found = value_at(self._tunable, at)
        if found is None:
            raise PicoError(error("device-reply", f"{self._address} is at `{at[:40]}`, which is no value of it"))
        return found


class _Position:
    """A measurable that is the position of a device."""

    colored = False

    def __init__(self, point: Point) -> None:
        self._instrument = point.instrument

    async def read(self, wavelength: float | None = None) -> Readout:
        found: Readout = await self._instrument.position()
        return found


async def _reads(choice: Choice) -> str:
    return f"{shown(await choice.position())} (of {', '.join(await choice.choices())})"


KIND = InstrumentKind(
    name="choice", about="named positions, of which it has one at a time", protocol=Choice, reads=_reads, by_name=True,
    drives=lambda point: _Chosen(point) if point.tunable is not None else None, measures=_Position,
)  # fmt: skip
