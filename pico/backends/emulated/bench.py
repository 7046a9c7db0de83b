"""Brings up emulators of all devices of a bench, and the world behind them."""

from __future__ import annotations

import os
import sys
from dataclasses import replace

from pico.backends.emulated.behind import OfArm, OfCamera, OfGantry, OfInput, OfPart, SharedEyes
from pico.backends.emulated.world import EmulatedWorld
from pico.diagnostics import PicoError, error
from pico.drivers.registry import driver
from pico.emulators.behind import Alone, Behind
from pico.emulators.registry import EmulatedBench
from pico.manifest.emulation import emulation_of
from pico.model.instruments.kinds import kind_of
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry
from pico.places.bench import BenchPlace

PACE = "PICO_EMULATED_PACE"
"""The variable that says how many times faster than the wall's an emulated bench's time goes; 1 without it."""


def brought_up(
    setup: Setup, place: BenchPlace, entries: dict[str, DeviceEntry]
) -> tuple[EmulatedWorld, EmulatedBench]:  # fmt: skip
    """Start an emulator for each link of a lab's devices, and return the world behind them with the running bench,
    whose `entries` lead to them, and whose `failed` have none. Raises PicoError for a world or a
    scenario that can't be read."""
    pace, scenario = _pace(), emulation_of(place.root, setup)
    unsafe = {name: one.unsafe for name, one in scenario.devices.items() if one.unsafe is not None}
    world = EmulatedWorld(setup, place, pace, people=tuple(scenario.people.values()), unsafe=unsafe)
    eyes = SharedEyes(world)
    eyes.open()

    def behind(name: str, entry: DeviceEntry) -> Behind:
        about, of = driver(entry.driver), entry.of or name
        if of in setup.lab.robots:
            return OfGantry(world, of) if setup.lab.robots[of].model == "gantry" else OfArm(world, of)
        if kind_of(about.kind).role == "safety input":
            return OfInput(world, name)
        if of in setup.lab.inventory:
            return OfPart(world, name, entry, of, about)
        return OfCamera(world, of, eyes) if of in setup.lab.cameras else Alone()

    paced = {name: _paced(entry, pace) for name, entry in entries.items()}
    if scenario.devices:
        sys.stderr.write(f"emulation: what goes wrong is drawn from seed {scenario.seed}\n")
    return world, EmulatedBench(paced, behind, scenario.devices, scenario.seed)


def _paced(entry: DeviceEntry, pace: float) -> DeviceEntry:
    """Return the entry of an arm with the pace at which it is driven, if its driver sends set-points by its own
    clock."""
    if pace == 1.0 or "pace" not in (driver(entry.driver).settings or {}):
        return entry
    return replace(entry, settings={**entry.settings, "pace": pace})


def _pace() -> float:
    said = os.environ.get(PACE, "1")
    try:
        pace = float(said)
    except ValueError:
        pace = 0.0
    if not 0 < pace <= 100:
        raise PicoError(error("pace", f"{PACE}={said[:20]} is no pace", hint="above 0 to 100, such as 10"))
    return pace
