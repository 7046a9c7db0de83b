"""The step `dark`: what cameras in the beam and power meters read without light."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.backends.hardware.powers import read_as
from pico.bench.calibrating.at_table import AtTable, Stopped
from pico.bench.calibrating.pictured import corners_drawn
from pico.diagnostics import PicoError, error
from pico.model.calibration.results import DarkLevel, Provenance

if TYPE_CHECKING:
    from pico.backends.hardware.instruments import Instruments

PROCEDURE = "dark/1"
FRAMES = 8
"""Pictures that are taken of a camera."""
READINGS = 20
"""Readings that are taken of a meter."""


def dark(at: AtTable, address: str) -> tuple[DarkLevel, Provenance, str]:
    """Find what the detector of `address` reads without light: how, and in words. Raises PicoError."""
    component, _, name = address.partition(".")
    at.require_dark(f"the dark level of {component}")
    if not at.asks.confirm(f"Is {component} covered, or the room dark?"):
        raise Stopped
    bench: Instruments = at.wait(at.device.links.instruments())
    if name == "image" and component in bench.sensors:
        found, spread = at.wait(_pictures(at, bench, component, at.pictures / f"dark-{component}.png"))
    else:
        found, spread = at.wait(_powers(at, bench, address))
    how = at.provenance(
        PROCEDURE, at.devices_of(component), residual=spread, held_out=None, unit=found.unit,
        uncertainty={f"level_{found.unit}": found.sigma},
    )  # fmt: skip
    return found, how, f"{address}: {found.level:.4g} ± {found.sigma:.2g} {found.unit} without light"


async def _pictures(at: AtTable, bench: Instruments, component: str, path: Path) -> tuple[DarkLevel, float]:
    import numpy as np

    driven = bench.tunables.get(f"{component}.exposure")
    said = (await driven.read()).value if driven is not None else None
    exposure = float(said) if isinstance(said, int | float) else None
    frames = [np.asarray(await bench.sensors[component].grab(exposure=exposure), np.float64) for _ in range(FRAMES)]
    means = [float(frame.mean()) for frame in frames]
    level, noise = sum(means) / FRAMES, float(np.std(np.stack(frames), axis=0, ddof=1).mean())
    spread = math.sqrt(sum((mean - level) ** 2 for mean in means) / (FRAMES - 1))
    sigma = max(spread / math.sqrt(FRAMES), noise / math.sqrt(FRAMES * frames[0].size), 1e-6)
    shown: Any = np.mean(frames, axis=0)
    gray = np.clip((shown - shown.min()) / ((np.ptp(shown)) or 1.0) * 255, 0, 255).astype(np.uint8)
    corners_drawn(gray, [], path)
    return DarkLevel(level=level, sigma=sigma, noise=noise, unit="count", exposure=exposure), spread


async def _powers(at: AtTable, bench: Instruments, address: str) -> tuple[DarkLevel, float]:
    metered, values = bench.meters[address], list[float]()
    component, _, name = address.partition(".")
    for _ in range(READINGS):
        reading = read_as(await metered.measured.read(None), metered.conversion)
        if not isinstance(reading.value, int | float) or isinstance(reading.value, bool):
            text = f"{address} gives no number without light: {reading.unknown or 'no value'}"
            raise PicoError(error("calibration-dark", text, address=address))
        values.append(float(reading.value))
    level = sum(values) / len(values)
    spread = math.sqrt(sum((value - level) ** 2 for value in values) / (len(values) - 1))
    unit = at.device.setup.measurables_of(component)[name].unit
    return DarkLevel(level=level, sigma=spread / math.sqrt(len(values)), noise=spread, unit=unit), spread
