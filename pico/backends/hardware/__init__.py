"""The real bench, and one that is emulated: the same device, whose links lead elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from pico.model.setup import Setup
from pico.places.bench import BenchPlace

if TYPE_CHECKING:
    from pico.backends.device import Device


def opened(setup: Setup, place: BenchPlace, fidelity: str, clock: Callable[[], str]) -> Device:
    """Return the bench at `place`, with its real arms, cameras and mounts; raises PicoError naming
    what of it has no driver. Nothing is contacted yet."""
    from pico.backends.hardware.opening import bench

    return bench(setup, place, fidelity, clock)
