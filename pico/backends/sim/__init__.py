"""The simulated bench."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from pico.model.setup import Setup
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.device import Device


def opened(setup: Setup, place: BenchPlace, fidelity: str, clock: Callable[[], str]) -> Device:
    """Return the simulated bench at `place`."""
    from pico.backends.sim.device import SimDevice

    return SimDevice(setup, place, fidelity, clock=clock)
