"""The power that leaves the far end of a fiber [mW]: of each beam what is in the fiber's mode."""

from __future__ import annotations

import math

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.lighted import alone, detects, light_on, uncertain
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup

SPECK = 1e-6
"""The share of the light on a fiber below which its shape does not matter."""


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the power of a fiber."""
    return detects(setup, component, measurable, "power") and "mode_radius" in setup.type_of(component).parameters


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the power with its standard deviation; unknown where the shape of a beam is."""
    import numpy as np

    from pico.optics.offsets import coupled

    light = light_on(table)
    part, arrivals = light.parts.get(component), light.at(component)
    if part is None:
        raise Failed(error("missing", f"{component} does not stand on the table", address=component))
    if cut := uncertain(light, component):
        return cut
    strong = tuple(a for a in arrivals if a.power > SPECK * sum(b.power for b in arrivals))
    why = alone(strong) or next((a.beam.unknown for a in strong if a.beam.unknown), "")
    if not why and any(a.beam.quality > 1 + 1e-9 for a in strong):
        why = "a beam of M2 above 1 has other modes, and nobody says how much of each"
    if why:
        return Reading(None, unknown=f"what {component} takes is not known: {why}")
    power = sum(coupled(part, a.beam) * a.power for a in arrivals) * part.number("transmission", "", 1.0)
    power = power * part.unseen.gain + part.unseen.dark
    least = part.number("least_power", "mW", 1e-6)
    noise = np.random.default_rng([table.world.seed, round(table.world.clock * 1000), *component.encode()])
    sigma = math.hypot(least, NOISE * power)
    return Reading(power + sigma * float(noise.standard_normal()), sigma=sigma, saturated="")


NOISE = 0.001
"""Of a reading, as a share of it: what the connector at the far end and the meter make from one to the next."""
