"""What sets a tunable of a component on a real bench, and reads it back, in the lab's units."""

from __future__ import annotations

from typing import Protocol

from pico.backends.hardware.settings import Settings
from pico.diagnostics import PicoError, error
from pico.drivers.protocols import Axis, Camera, Instrument, Lamp, Laser, PowerMeter, Shutter
from pico.model.catalog import Tunable
from pico.model.instruments.conversion import Conversion
from pico.model.observation import ObservedValue
from pico.model.quantities import Value

UNKNOWN = ObservedValue(status="unknown")
_NO_AXIS = PicoError(error("no-axis", "it has no axis that could be homed"))


class Driven(Protocol):
    """A tunable with a device. `moves`: something turns or slides for it."""

    moves: bool

    @property
    def instrument(self) -> Instrument: ...

    async def read(self) -> ObservedValue:
        """Return what it is; unknown where the device does not know. Raises PicoError where that can't be asked."""
        ...

    async def set(self, value: Value) -> Value:
        """Bring it to a value, and return what is read back; raises PicoError."""
        ...

    async def home(self) -> Value:
        """Find its zero, and return what is read there; raises PicoError."""
        ...


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


class Tuned:
    """The wavelength for which a power meter corrects its reading."""

    moves = False

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

    async def home(self) -> Value:
        raise _NO_AXIS


class Shut:
    """A shutter: its sensor says what it is."""

    moves = False

    def __init__(self, shutter: Shutter) -> None:
        self.instrument = shutter

    async def read(self) -> ObservedValue:
        found = await self.instrument.is_open()
        return UNKNOWN if found is None else ObservedValue(value=word(found))

    async def set(self, value: Value) -> Value:
        return word(await self.instrument.open(value == "open"))

    async def home(self) -> Value:
        raise _NO_AXIS


class Emitting:
    """A laser: what it reports of itself."""

    moves = False

    def __init__(self, laser: Laser) -> None:
        self.instrument = laser

    async def read(self) -> ObservedValue:
        found = await self.instrument.emitting()
        return UNKNOWN if found is None else ObservedValue(value=found)

    async def set(self, value: Value) -> Value:
        return await self.instrument.emit(value is True)

    async def home(self) -> Value:
        raise _NO_AXIS


class Lit:
    """A lamp, which tells nothing: it is what it was told last, and unknown at first."""

    moves = False

    def __init__(self, lamp: Lamp, settings: Settings, address: str) -> None:
        self.instrument, self._settings, self._address = lamp, settings, address

    async def read(self) -> ObservedValue:
        found = self._settings.get(self._address, "")
        return ObservedValue(value=found) if isinstance(found, bool) else UNKNOWN

    async def set(self, value: Value) -> Value:
        found = await self.instrument.shine(value is True)
        self._settings.put(self._address, found)
        return found

    async def home(self) -> Value:
        raise _NO_AXIS


def word(found: bool) -> str:
    """Return what a shutter is, by whether it is open."""
    return "open" if found else "closed"


class Exposed:
    """A setting of a camera, which is told with every picture: what was set last, the lab's initial value at first."""

    moves = False

    def __init__(self, camera: Camera, settings: Settings, address: str, kind: Tunable) -> None:
        self.instrument, self._settings, self._address = camera, settings, address
        low = kind.range[0] if kind.range else 0.0
        self._first = low if kind.initial is None else kind.initial

    async def read(self) -> ObservedValue:
        return ObservedValue(value=self._settings.get(self._address, self._first))

    async def set(self, value: Value) -> Value:
        self._settings.put(self._address, value)
        return value

    async def home(self) -> Value:
        raise _NO_AXIS
