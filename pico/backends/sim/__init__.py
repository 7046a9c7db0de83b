"""The simulated bench."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from pico.model.setup import Setup

if TYPE_CHECKING:
    from pico.backends.device import Device


def opened(setup: Setup, root: Path, fidelity: str, clock: Callable[[], str]) -> Device:
    """Return the simulated bench of the lab in folder `root`."""
    from pico.backends.sim.device import SimDevice

    return SimDevice(setup, root, fidelity, clock=clock)
