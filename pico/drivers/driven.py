"""What sets a tunable of a component on a real bench, and reads it back, in the lab's units."""

from __future__ import annotations

from pico.diagnostics import PicoError, error
from pico.drivers.protocols import Axis, Camera, Lamp, Laser, PowerMeter, Shutter
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.kind import Memory
from pico.model.instruments.readout import Readout
from pico.model.observation import ObservedValue
from pico.model.quantities import Value

UNKNOWN = ObservedValue(status="unknown")
NO_AXIS = PicoError(error("no-axis", "it has no axis that could be homed"))


class WithoutAxis:
    """A tunable without an axis: it is not homed."""

    moves = False

    async def home(self) -> Value:
        """Raise PicoError: there is nothing to home."""
        raise NO_AXIS


class Motorized:
    """An axis: what the lab says is wired to what the device has."""

    moves = True

    def __init__(self, axis: Axis, conversion: Conversion) -> None:
        self.instrument, self._conversion = axis, conversion

    async def read(self) -> ObservedValue:
        at = await self.instrument.position()
        return UNKNOWN if at is None else ObservedValue(value=self._conversion.to_lab(at))

    async def set(self, value: Value) -> Value:
        return self._conversion.to_lab(await self.instrument.move_to(self._conversion.to_device(float(value))))

    async def home(self) -> Value:
        return self._conversion.to_lab(await self.instrument.home())


class Powered:
    """The power that a meter reads [W], corrected for the wavelength of the light."""

    colored = True

    def __init__(self, meter: PowerMeter) -> None:
        self._meter = meter

    async def read(self, wavelength: float | None = None) -> Readout:
        return await self._meter.power(wavelength=wavelength)


class Tuned(WithoutAxis):
    """The wavelength for which a power meter corrects its reading."""

    def __init__(self, meter: PowerMeter, conversion: Conversion) -> None:
        self.instrument, self._conversion = meter, conversion

    async def read(self) -> ObservedValue:
        found = (await self.instrument.wavelength()).value
        return UNKNOWN if not isinstance(found, int | float) else ObservedValue(value=self._conversion.to_lab(found))

    async def set(self, value: Value) -> Value:
        found = await self.instrument.set_wavelength(self._conversion.to_device(float(value)))
        if not isinstance(found.value, int | float):
            raise PicoError(error("device-reply", f"the meter does not tell its wavelength: {found.why}"))
        return self._conversion.to_lab(found.value)


class Shut(WithoutAxis):
    """A shutter: its sensor says what it is."""

    def __init__(self, shutter: Shutter) -> None:
        self.instrument = shutter

    async def read(self) -> ObservedValue:
        found = await self.instrument.is_open()
        return UNKNOWN if found is None else ObservedValue(value=word(found))

    async def set(self, value: Value) -> Value:
        return word(await self.instrument.open(value == "open"))


class Emitting(WithoutAxis):
    """A laser: what it reports of itself."""

    def __init__(self, laser: Laser) -> None:
        self.instrument = laser

    async def read(self) -> ObservedValue:
        found = await self.instrument.emitting()
        return UNKNOWN if found is None else ObservedValue(value=found)

    async def set(self, value: Value) -> Value:
        return await self.instrument.emit(value is True)


class Lit(WithoutAxis):
    """A lamp, which tells nothing: it is what it was told last, and unknown at first."""

    def __init__(self, lamp: Lamp, memory: Memory, address: str) -> None:
        self.instrument, self._memory, self._address = lamp, memory, address

    async def read(self) -> ObservedValue:
        found = self._memory.get(self._address, "")
        return ObservedValue(value=found) if isinstance(found, bool) else UNKNOWN

    async def set(self, value: Value) -> Value:
        found = await self.instrument.shine(value is True)
        self._memory.put(self._address, found)
        return found


def word(found: bool) -> str:
    """Return what a shutter is, by whether it is open."""
    return "open" if found else "closed"


class Exposed(WithoutAxis):
    """A setting of a camera, which is sent with every picture: what was set last. At first it is `first`, what an
    emulated camera has after power-up by its type; unknown without."""

    def __init__(self, camera: Camera, memory: Memory, address: str, first: Value | None = None) -> None:
        self.instrument, self._memory, self._address, self._first = camera, memory, address, first

    async def read(self) -> ObservedValue:
        found = self._memory.get(self._address, "" if self._first is None else self._first)
        return UNKNOWN if found == "" else ObservedValue(value=found)

    async def set(self, value: Value) -> Value:
        self._memory.put(self._address, value)
        return value
