"""The instruments of a bench by what its lab names: which arm, which tunable, which measurable each of them is."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, cast

from pico.backends.conversions import conversion_of, mapped
from pico.backends.hardware.settings import Settings
from pico.backends.hardware.tunables import Driven, Emitting, Exposed, Lit, Motorized, Shut, Tuned
from pico.diagnostics import Diagnostic, PicoError, error
from pico.drivers.driver import Driver
from pico.drivers.protocols import Arm, Camera, Gripper, Identity, Instrument, PowerMeter, SafetyInput
from pico.model.instruments.conversion import Conversion
from pico.model.instruments.declaration import Declaration
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, SafetyEntry

if TYPE_CHECKING:
    from pico.drivers.registry import Buses


@dataclass(frozen=True, eq=False)
class Metered:
    """A power meter, and what a lab makes of the watts that it reads."""

    meter: PowerMeter
    conversion: Conversion


@dataclass(eq=False)
class Instruments:
    """The instruments of a bench: arms and grippers by robot, cameras over the bench by name, cameras in the beam
    (`sensors`) by component, tunables and meters by address, safety inputs by name. `all`: every one, by device;
    `maturity`: how far the driver of each was tried; `who`: who answered, once they are connected."""

    arms: dict[str, Arm] = field(default_factory=dict)
    grippers: dict[str, Gripper] = field(default_factory=dict)
    cameras: dict[str, Camera] = field(default_factory=dict)
    sensors: dict[str, Camera] = field(default_factory=dict)
    tunables: dict[str, Driven] = field(default_factory=dict)
    meters: dict[str, Metered] = field(default_factory=dict)
    inputs: dict[str, tuple[SafetyEntry, SafetyInput]] = field(default_factory=dict)
    all: dict[str, Instrument] = field(default_factory=dict)
    maturity: dict[str, str] = field(default_factory=dict)
    who: dict[str, Identity] = field(default_factory=dict)

    async def connect(self) -> None:
        """Connect to every one of them; raises PicoError for all that fail at once."""
        found = await asyncio.gather(*(one.connect() for one in self.all.values()), return_exceptions=True)
        wrong: list[Diagnostic] = []
        for name, result in zip(self.all, found, strict=True):
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
    """Put an instrument where the lab has it."""
    of, kind = entry.of or name, about.kind
    found.all[name] = one
    if kind == "arm":
        found.arms[of] = one
    elif kind == "gripper":
        found.grippers[of] = one
    elif kind in ("camera", "depth camera") and of not in setup.lab.inventory:
        found.cameras[of] = one
    elif kind in ("camera", "depth camera"):
        found.sensors[of] = one
        for tunable in ("exposure", "gain"):
            if tunable in setup.type_of(of).tunables:
                kept = setup.type_of(of).tunables[tunable]
                found.tunables[f"{of}.{tunable}"] = Exposed(one, settings, f"{of}.{tunable}", kept)
    elif kind != "safety input":
        for key, wired in mapped(setup, about, entry, of).items():
            _put(
                found,
                f"{of}.{key}",
                kind,
                one,
                wired.property,
                conversion_of(setup, about, entry, of, key, wired),
                settings,
            )


def _put(
    found: Instruments, address: str, kind: str, one: Any, prop: str, conversion: Conversion, settings: Settings
) -> None:
    """Put what sets or reads a tunable or measurable where the lab has it."""
    if kind == "axis":
        found.tunables[address] = Motorized(one, conversion)
    elif kind == "power meter" and prop == "wavelength":
        found.tunables[address] = Tuned(one, conversion)
    elif kind == "power meter":
        found.meters[address] = Metered(one, conversion)
    else:
        switches = {"shutter": Shut, "laser": Emitting}
        found.tunables[address] = switches[kind](one) if kind in switches else Lit(one, settings, address)


def wired(setup: Setup, entries: Mapping[str, DeviceEntry], buses: Buses, settings: Settings) -> Instruments:
    """Return the instruments of a lab's devices, none of them connected; raises PicoError for all that can't be had."""
    from pico.drivers.registry import driver

    found, wrong = Instruments(), list[Diagnostic]()
    for name, entry in entries.items():
        try:
            about: Driver = driver(entry.driver)
            one = buses.opened(name, entry)
        except PicoError as exc:
            wrong += exc.diagnostics
            continue
        found.maturity[name] = about.maturity
        add(setup, found, name, entry, about, one, settings)
    wiring = setup.wiring
    for name, said in (wiring.safety_inputs if wiring else {}).items():
        if said.device in found.all:
            found.inputs[name] = said, cast(SafetyInput, found.all[said.device])
    if wrong:
        raise PicoError(wrong)
    return found


def require_whole(setup: Setup, entries: Mapping[str, DeviceEntry], kinds: Mapping[str, str]) -> None:
    """Raise PicoError where a bench lacks what nothing works without: its arms with their grippers, and cameras over
    the table; `kinds`: what each device is."""
    has = {(kinds.get(name, ""), entry.of or name) for name, entry in entries.items()}
    missing = []
    for name, robot in sorted(setup.lab.robots.items()):
        if ("arm", name) not in has:
            missing.append(f"no driver for the arm {name} ({robot.model})")
        elif robot.gripper.fingers != "none" and ("gripper", name) not in has:
            missing.append(f"no driver for the gripper of {name}")
    over = sorted(name for name, camera in setup.lab.cameras.items() if camera.robot is None)
    eyes = [name for name in over if {("camera", name), ("depth camera", name)} & has]
    if not eyes:
        missing.append("no driver for cameras, so that nobody sees where the components stand")
    elif set(over) - set(eyes):
        missing.append(f"no driver for the camera {', '.join(sorted(set(over) - set(eyes)))}")
    if not entries and (motors := _driven(setup)):
        missing.append(f"no driver for {', '.join(motors)}")
    if missing:
        hint = "`--backend sim` works on the simulated bench; docs/how-to/hardware.md says how a bench is wired"
        text = "the real bench cannot be used yet"
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
