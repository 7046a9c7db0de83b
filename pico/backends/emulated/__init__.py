"""The real bench's drivers, led to emulators of its devices with a simulated world behind them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from pico.model.setup import Setup
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.device import Device


def opened(setup: Setup, place: BenchPlace, fidelity: str, clock: Callable[[], str]) -> Device:
    """Return the emulated bench at `place`; raises PicoError naming what of it has no driver. Nothing
    is contacted yet."""
    from pico.backends.emulated.bench import brought_up
    from pico.backends.hardware.opening import bench

    return bench(setup, place, fidelity, clock, brought_up)
