"""The real bench's drivers, led to emulators of its devices with a simulated world behind them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.backends.device import Device


def opened(setup: Setup, root: Path, fidelity: str, clock: Callable[[], str]) -> Device:
    """Return the emulated bench of the lab in folder `root`; raises PicoError naming what of it has no driver. Nothing
    is contacted yet."""
    from pico.backends.emulated.bench import brought_up
    from pico.backends.hardware.opening import bench

    return bench(setup, root, "emulated", fidelity, clock, brought_up)
