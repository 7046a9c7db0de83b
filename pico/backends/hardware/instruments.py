"""The instruments of a bench by what its lab names: which arm, which tunable, which measurable each of them is."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, cast

from pico.backends.hardware.settings import Settings
from pico.diagnostics import Diagnostic, PicoError, error
from pico.drivers.driven import Exposed
from pico.drivers.driver import Driver
from pico.drivers.protocols import Arm, Camera, Gripper, Identity, Instrument, SafetyInput
from pico.drivers.stand_in import Lacking, StandIn
from pico.model.calibration.results import AxisZero, DarkLevel
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.conversions import conversion_of
from pico.model.instruments.declaration import Declaration
from pico.model.instruments.kind import Driven, Measured, Point
from pico.model.instruments.kinds import kind_of
from pico.model.instruments.mapping import mapped
from pico.model.observation import LACKING
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, SafetyEntry, Wired

if TYPE_CHECKING:
    from pico.drivers.registry import Buses
    from pico.vision.calibration import Calibration


@dataclass(frozen=True, eq=False)
class Metered:
    """What reads a measurable, and what a lab makes of the number that it reads."""

    measured: Measured
    conversion: Conversion


@dataclass(eq=False)
class Instruments:
    """The instruments of a bench: arms and grippers by robot, cameras over the bench by name, cameras in the beam
    (`sensors`) by component, tunables and meters by address, safety inputs by name. `all`: every one, by device;
    `lacking`: why one of them can't be had, by device; `maturity`: how far the driver of each was tried; `who`: who
    answered, once they are connected."""

    arms: dict[str, Arm] = field(default_factory=dict)
    grippers: dict[str, Gripper] = field(default_factory=dict)
    cameras: dict[str, Camera] = field(default_factory=dict)
    sensors: dict[str, Camera] = field(default_factory=dict)
    tunables: dict[str, Driven] = field(default_factory=dict)
    meters: dict[str, Metered] = field(default_factory=dict)
    inputs: dict[str, tuple[SafetyEntry, SafetyInput]] = field(default_factory=dict)
    all: dict[str, Instrument] = field(default_factory=dict)
    lacking: dict[str, tuple[Diagnostic, ...]] = field(default_factory=dict)
    armless: dict[str, tuple[Diagnostic, ...]] = field(default_factory=dict)
    """Why the arm of a robot, or its gripper, can't be had: nobody knows where it stands then, or what it holds."""
    maturity: dict[str, str] = field(default_factory=dict)
    who: dict[str, Identity] = field(default_factory=dict)
    axes: Mapping[str, AxisZero] = field(default_factory=dict)
    """Direction and zero of axes as they were calibrated, by the address of the tunable."""
    dark: Mapping[str, DarkLevel] = field(default_factory=dict)
    """What detectors read without light as it was calibrated, by the address of the measurable."""

    async def connect(self) -> None:
        """Connect to every one of them that there is; raises PicoError for all that fail at once."""
        there = {name: one for name, one in self.all.items() if name not in self.lacking}
        found = await asyncio.gather(*(one.connect() for one in there.values()), return_exceptions=True)
        wrong: list[Diagnostic] = []
        for name, result in zip(there, found, strict=True):
            if isinstance(result, PicoError):
                wrong += result.diagnostics
            elif isinstance(result, BaseException):
                raise result
            else:
                self.who[name] = result
        if wrong:
            raise PicoError(wrong)

    async def stop(self) -> None:
        """Stop all that moves, at once, whatever becomes of the others."""
        moving = {id(one): one for one in (*self.arms.values(), *self.grippers.values())}
        moving |= {id(one.instrument): one.instrument for one in self.tunables.values() if one.moves}
        await asyncio.gather(*(one.stop() for one in moving.values()), return_exceptions=True)


def add(
    setup: Setup, found: Instruments, name: str, entry: DeviceEntry, about: Declaration, one: Any, settings: Settings
) -> None:
    """Put an instrument where the lab has it; raises PicoError for a kind that there is not."""
    of, role = entry.of or name, kind_of(about.kind).role
    found.all[name] = one
    if name in found.lacking and role in ("arm", "gripper", "camera") and of not in setup.lab.inventory:
        return  # nothing is known of an arm that can't be had, and a camera that can't be had sees nothing
    if role == "arm":
        found.arms[of] = one
    elif role == "gripper":
        found.grippers[of] = one
    elif role == "camera" and of not in setup.lab.inventory:
        found.cameras[of] = one
    elif role == "camera":
        found.sensors[of] = one
        for tunable in ("exposure", "gain"):
            if tunable in setup.type_of(of).tunables:
                first = setup.type_of(of).tunables[tunable].initial if settings.emulated else None
                found.tunables[f"{of}.{tunable}"] = Exposed(one, settings, f"{of}.{tunable}", first)
    elif role == "part" and of in setup.lab.inventory:
        for key, wired in mapped(setup, about, entry, of).items():
            _put(setup, found, entry, about, one, of, key, wired, settings)


def _put(
    setup: Setup, found: Instruments, entry: DeviceEntry, about: Declaration, one: Any, of: str, key: str,
    wired: Wired, settings: Settings,
) -> None:  # fmt: skip
    """Put what sets or reads a tunable or measurable where the lab has it."""
    kind, address = kind_of(about.kind), f"{of}.{key}"
    conversion = conversion_of(setup, about, entry, of, key, wired, found.axes)
    point = Point(
        instrument=one, address=address, property=wired.property, conversion=conversion,
        tunable=setup.type_of(of).tunables.get(key), memory=settings,
        writable=about.writable(entry, wired.property),
    )  # fmt: skip
    if (driven := kind.drives(point)) is not None:
        found.tunables[address] = driven
    elif (measured := kind.measures(point)) is not None:
        found.meters[address] = Metered(measured, point.conversion)


def wired(
    setup: Setup, entries: Mapping[str, DeviceEntry], buses: Buses, settings: Settings,
    without: Mapping[str, Sequence[Diagnostic]] = MappingProxyType({}), known: Calibration | None = None,
) -> Instruments:  # fmt: skip
    """Return the instruments of a lab's devices, none of them connected.

    `without`: why some can't be had; `known`: how the bench is calibrated. What can't be had, and what has a driver
    that is not installed, or is broken, answers every call with the reason (`lacking`). Raises PicoError for an entry
    that does not go with its driver, and for an extra that is missing.
    """
    from pico.drivers.registry import driver_of

    found, wrong = Instruments(), list[Diagnostic]()
    if known is not None:
        found.axes, found.dark = known.axes, known.dark
    for name, entry in entries.items():
        about: Driver | None = None
        try:
            about = driver_of(entry)
            found.maturity[name] = about.maturity
            if name in without:
                raise PicoError(without[name])
            add(setup, found, name, entry, about, buses.opened(name, entry), settings)
        except PicoError as exc:
            if not all(one.code in LACKING for one in exc.diagnostics):
                wrong += exc.diagnostics
                continue
            found.lacking[name] = told = tuple(_of_device(name, one) for one in exc.diagnostics)
            if (entry.of or name) in setup.lab.robots:
                found.armless[entry.of or name] = told
            if about is not None:
                add(setup, found, name, entry, about, StandIn(told), settings)
            else:
                _add_unknown(setup, found, name, entry, StandIn(told))
    wiring = setup.wiring
    for name, said in (wiring.safety_inputs if wiring else {}).items():
        if said.device in found.all:
            found.inputs[name] = said, cast(SafetyInput, found.all[said.device])
    if wrong:
        raise PicoError(wrong)
    return found


def _of_device(name: str, why: Diagnostic) -> Diagnostic:
    text = why.summary if name in why.summary else f"{name} can't be used: {why.summary}"
    return replace(why, summary=text, address=name)


UNKNOWN = "unknown"
"""The kind of a device whose driver is not installed, or is broken: it may be any."""


def _add_unknown(setup: Setup, found: Instruments, name: str, entry: DeviceEntry, one: Any) -> None:
    """Put what stands in for an instrument of unknown kind wherever the lab may have it."""
    of = entry.of or name
    found.all[name] = one
    if of in setup.lab.inventory:
        tunables = setup.type_of(of).tunables
        for key in entry.map:
            if key in tunables:
                found.tunables[f"{of}.{key}"] = Lacking(one)
            else:
                found.meters[f"{of}.{key}"] = Metered(Lacking(one), Conversion(wired=entry.map[key]))


def require_whole(setup: Setup, entries: Mapping[str, DeviceEntry], kinds: Mapping[str, str]) -> None:
    """Raise PicoError where a bench lacks what nothing works without: its arms with their grippers, and cameras over
    the table; `kinds`: what each device is."""
    has = {(kinds.get(name, ""), entry.of or name) for name, entry in entries.items()}
    has |= {(kind, of) for known, of in has if known == UNKNOWN for kind in ("arm", "gripper", "camera")}
    missing = []
    for name, robot in sorted(setup.lab.robots.items()):
        if ("arm", name) not in has:
            missing.append(f"no driver for the arm {name} ({robot.model})")
        elif ("gripper", name) not in has:
            missing.append(f"no driver for the gripper of {name}, without which it holds nothing")
    over = sorted(name for name, camera in setup.lab.cameras.items() if camera.robot is None)
    eyes = [name for name in over if {("camera", name), ("depth camera", name)} & has]
    loose = sorted(name for name in setup.lab.inventory if setup.loose(name))
    if not eyes and loose:
        missing.append(f"no driver for a camera over the table, so it is not seen where {', '.join(loose[:5])} stand")
    elif eyes and set(over) - set(eyes):
        missing.append(f"no driver for the camera {', '.join(sorted(set(over) - set(eyes)))}")
    if not entries and (motors := _driven(setup)):
        missing.append(f"no driver for {', '.join(motors)}")
    if missing:
        hint = "`--backend sim` works on the simulated bench; docs/how-to/hardware.md says how a bench is wired"
        text = "the devices of this bench cannot be used yet"
        raise PicoError(error("no-hardware", text, detail="\n".join(missing), hint=hint))


def _driven(setup: Setup) -> list[str]:
    """The tunables that a motor or electronics set."""
    return sorted(
        f"{name}.{tunable}"
        for name in setup.lab.inventory
        for tunable, kind in setup.type_of(name).tunables.items()
        if kind.mover in ("motor", "electronics")
    )


def unwired(setup: Setup, found: Instruments) -> tuple[str, ...]:
    """Return the tunables that a motor or electronics set, and no device: nobody reads them."""
    return tuple(address for address in _driven(setup) if address not in found.tunables)
