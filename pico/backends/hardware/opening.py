"""Opening a bench by the wiring of its lab."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from pico.backends.hardware.device import HardwareDevice
from pico.backends.hardware.instruments import UNKNOWN, require_whole
from pico.backends.hardware.links import BringUp, links
from pico.drivers.registry import known_driver
from pico.model.setup import Setup
from pico.places.bench import BenchPlace


def bench(
    setup: Setup, place: BenchPlace, fidelity: str, clock: Callable[[], str], bring_up: BringUp | None = None
) -> HardwareDevice:  # fmt: skip
    """Return the `hardware` or the `emulated` bench at `place`; raises PicoError naming what it lacks.
    `bring_up`: of the one that is emulated."""
    setup = _with_wiring(setup, place.root)
    entries = setup.wiring.devices if setup.wiring else {}
    found = {device: known_driver(entry.driver) for device, entry in entries.items()}
    require_whole(setup, entries, {device: about.kind if about else UNKNOWN for device, about in found.items()})
    return HardwareDevice(setup, place, links(setup, place, bring_up), fidelity, clock=clock)


def _with_wiring(setup: Setup, root: Path) -> Setup:
    """Return the bench with its instruments, as the files of its folder name them: how it is wired is no part of the
    Lab that a bench keeps."""
    if setup.wiring is not None:
        return setup
    from pico.manifest.load import load_folder

    found = load_folder(root).setup
    return replace(setup, wiring=found.wiring) if found is not None else setup
