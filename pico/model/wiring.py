"""How a bench is wired: which instrument stands behind what the lab names, and how it is reached. No part of what a
plan is: the same plan moves a simulated bench, an emulated and a real one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from itertools import chain
from math import ceil
from typing import Literal

from pico.model.quantities import QuantityError, convert, dimension
from pico.model.record import record

SafetyKind = Literal["door", "curtain", "emergency_stop", "key", "interlock", "shutter"]


@record
class Wired:
    """The driver's property that a tunable or measurable stands for. What the lab says is `scale` times what the
    device has, plus `offset`, in `unit`. Without `unit` that is the unit that the driver declares of the property."""

    property: str
    scale: float = 1.0
    offset: float = 0.0
    unit: str | None = None

    def __post_init__(self) -> None:
        if self.scale == 0:
            raise ValueError("a `scale` is not 0")

    def to_device(self, value: float, unit: str) -> float:
        """Return the device's number for one of the lab's in `unit`."""
        return (_converted(value, unit, self.unit) - self.offset) / self.scale

    def to_lab(self, value: float, unit: str) -> float:
        """Return the lab's number in `unit` for one of the device's."""
        return _converted(value * self.scale + self.offset, self.unit, unit)


_TURN = "360 deg"
_MARGIN = 1e-9
"""How far beyond a limit a converted number may lie and is that limit nevertheless [of the limit's unit]."""


@record
class Conversion:
    """How the number of a device's property becomes the lab's, and back."""

    wired: Wired
    """What the lab's files say of it, `unit` filled in."""
    own: str = ""
    """The unit of the device's number, '' if the driver declares none."""
    unit: str = ""
    """The unit of the lab's number."""
    limits: tuple[float, float] | None = None
    """What the device may be told, in its own unit; None if nothing limits it."""
    range: tuple[float, float] | None = None
    """The range of the tunable, in the lab's unit."""
    period: float | None = None
    """After how much the tunable is the same again, in the lab's unit."""

    @property
    def _turn(self) -> float:
        """A full turn in the device's unit, 0 if its number is no angle."""
        return float(convert(_TURN, self.own)) if _is_angle(self.own) else 0.0

    def to_device(self, value: float) -> float:
        """Return the device's number for one of the lab's. An angle that the limits exclude is told as the same angle
        within them: by whole turns, or else by the period of the tunable."""
        at = self.wired.to_device(value, self.unit)
        if self.limits is None or not self._turn:
            return at
        low, high = self.limits
        steps = [0.0, self._turn]
        if self.period is not None:
            steps.append(abs(self.wired.to_device(self.period, self.unit) - self.wired.to_device(0.0, self.unit)))
        for one in chain.from_iterable(_shifted(at, low, step) for step in steps):
            if low - _MARGIN <= one <= high + _MARGIN:
                return min(max(one, low), high)
        return at

    def to_lab(self, value: float) -> float:
        """Return the lab's number for one of the device's; an angle beyond the range of the tunable as the same angle
        within it, if there is one by whole turns."""
        found = self.wired.to_lab(value, self.unit)
        if self.range is None or not self._turn or not _is_angle(self.unit):
            return found
        low, high = self.range
        for one in _shifted(found, low, float(convert(_TURN, self.unit))):
            if low <= one <= high:
                return one
        return found

    def spread(self, sigma: float) -> float:
        """Return one standard deviation of the lab's number for one of the device's."""
        return abs(self.wired.to_lab(sigma, self.unit) - self.wired.to_lab(0.0, self.unit))


def _shifted(value: float, low: float, step: float) -> Iterator[float]:
    """Yield a number as it is, and the least one from `low` on that differs from it by whole steps."""
    yield value
    if step:
        yield value + ceil((low - _MARGIN - value) / step) * step


def conversion(
    wired: Wired, own: str, unit: str, *, limits: tuple[float, float] | None = None,
    range: tuple[float, float] | None = None, period: float | None = None,
) -> Conversion:  # fmt: skip
    """Return how a property in `own` becomes a tunable or measurable in `unit`; for the rest see `Conversion`."""
    said = wired.unit or (own if own and unit and same_dimension(own, unit) else unit)
    return Conversion(
        wired=replace(wired, unit=said or None), own=own, unit=unit, limits=limits, range=range, period=period
    )


def same_dimension(one: str, other: str) -> bool:
    """Whether numbers in one unit can be converted into another; False for a unit that is unknown."""
    try:
        return one == other or dimension(one) == dimension(other)
    except QuantityError:
        return False


def _is_angle(unit: str) -> bool:
    return bool(unit) and same_dimension(unit, "deg")


def _converted(value: float, unit: str | None, wanted: str | None) -> float:
    return value if not unit or not wanted or unit == wanted else float(convert(f"{value!r} {unit}", wanted))


@record
class DeviceEntry:
    """One instrument: its `driver` by name, the `address` by which that reaches it, and the `identity` (`serial`,
    `model`, `vendor`, `firmware`) that must answer there. `of`: the component, robot or camera that it belongs to,
    where that is not its own name. `limits`: [least, greatest] of the driver's properties, in their units, kept by the
    driver. `map`: which property each tunable and measurable is. `settings`: what else the driver is told. `emulator`:
    what stands in for it with --emulate, where that is not what the driver names."""

    driver: str
    address: Mapping[str, str | int] = field(default_factory=dict)
    identity: Mapping[Literal["vendor", "model", "serial", "firmware"], str] = field(default_factory=dict)
    of: str | None = None
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    map: Mapping[str, Wired] = field(default_factory=dict)
    settings: Mapping[str, str | int | float | bool] = field(default_factory=dict)
    emulator: str | None = None

    def __post_init__(self) -> None:
        for name, (low, high) in self.limits.items():
            if low > high:
                raise ValueError(f"the limits of `{name}` are [least, greatest]")


@record
class SafetyEntry:
    """A safety input: what it is, the `device` that reads it, and the name of its shutter where it is one's sensor.
    `heartbeat`: how old what was heard of it may be [s]; what is older is unknown, and unsafe."""

    kind: SafetyKind
    device: str
    of: str | None = None
    heartbeat: float = 0.5

    def __post_init__(self) -> None:
        if not 0 < self.heartbeat <= 5:
            raise ValueError("a `heartbeat` is above 0 to 5 s")


@record
class Wiring:
    """The instruments of a lab by name, and its safety inputs."""

    lab: str
    devices: Mapping[str, DeviceEntry] = field(default_factory=dict)
    safety_inputs: Mapping[str, SafetyEntry] = field(default_factory=dict)

    def of(self, name: str) -> Mapping[str, DeviceEntry]:
        """Return the devices of a component, robot or camera, by their own names."""
        return {device: entry for device, entry in self.devices.items() if (entry.of or device) == name}
