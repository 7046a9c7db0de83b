"""How a bench is wired: which instrument stands behind what the lab names, and how it is reached. No part of what a
plan is: the same plan moves a simulated bench, an emulated and a real one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal

from pico.model.quantities import convert
from pico.model.record import record

SafetyKind = Literal["door", "curtain", "emergency_stop", "key", "interlock", "shutter"]

Scalar = str | int | float | bool


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


def _converted(value: float, unit: str | None, wanted: str | None) -> float:
    return value if not unit or not wanted or unit == wanted else float(convert(f"{value!r} {unit}", wanted))


@record
class DeviceEntry:
    """One instrument: its `driver` by name, the `address` by which that reaches it, and the `identity` (`serial`,
    `model`, `vendor`, `firmware`) that must answer there. `of`: the component, robot or camera that it belongs to,
    where that is not its own name. `limits`: [least, greatest] of the driver's properties, in their units, kept by the
    driver. `map`: which property each tunable and measurable is. `settings`: what else the driver is told. `emulator`:
    what stands in for it with --emulate, where that is not what the driver names. `package`: which package brings the
    driver, to be named where that is not installed."""

    driver: str
    address: Mapping[str, str | int] = field(default_factory=dict)
    identity: Mapping[Literal["vendor", "model", "serial", "firmware"], str] = field(default_factory=dict)
    of: str | None = None
    limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    map: Mapping[str, Wired] = field(default_factory=dict)
    settings: Mapping[str, Scalar | Mapping[str, Scalar]] = field(default_factory=dict)
    emulator: str | None = None
    package: str | None = None

    def __post_init__(self) -> None:
        for name, (low, high) in self.limits.items():
            if low > high:
                raise ValueError(f"the limits of `{name}` are [least, greatest], not [{low:g}, {high:g}]")

    def setting(self, name: str, default: Scalar) -> Scalar:
        """Return a setting that is no mapping; `default` without it."""
        said = self.settings.get(name, default)
        return default if isinstance(said, Mapping) else said


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
