"""What a spectrometer reads: the counts of its channels, and their mean wavelength and width."""

from __future__ import annotations

import math

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.lighted import alone, detects, light_on, sightless, uncertain
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the spectrum of a detector that has a resolution, or what is told of that."""
    found = any(detects(setup, component, measurable, what) for what in ("spectrum", "wavelength", "linewidth"))
    return found and setup.type_of(component).number("resolution", "nm") is not None


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the counts (1, n), with the brightest; or the mean wavelength or the width of what stands out of them."""
    from pico.optics.spectrum import FULL, channels, middle, recorded

    light = light_on(table)
    part, arrivals = light.parts.get(component), light.at(component)
    if part is None:
        raise Failed(error("missing", f"{component} does not stand on the table", address=component))
    if none := uncertain(light, component) or sightless(light, component):
        return none
    if why := alone(arrivals):
        return Reading(None, unknown=f"what {component} would see is not known: {why}")
    counts, sigma = recorded(arrivals, part, seed=table.world.seed, number=round(table.world.clock * 1000))
    at, full = channels(part), int((counts >= FULL).sum())
    saturated = f"{full} of {len(counts)} channels read {FULL:g}" if full else ""
    settings = {
        "exposure": part.value("exposure", "ms", 10.0), "resolution": part.number("resolution", "nm", 1.0),
        "first": float(at[0]), "step": float(at[1] - at[0]),
    }  # fmt: skip
    if measurable == "spectrum":
        return Reading({"peak": float(counts.max())}, counts[None, :], settings=settings, saturated=saturated)
    mean, width, of_mean, of_width = middle(counts, sigma, part)
    if math.isnan(mean):
        return Reading(None, unknown=f"no line stands out of the noise of {component}", settings=settings)
    if saturated:
        return Reading(None, unknown=f"saturated: {saturated}", settings=settings, saturated=saturated)
    value, error_of = (mean, of_mean) if measurable == "wavelength" else (width, of_width)
    return Reading(value, sigma=error_of, settings=settings, saturated="")
