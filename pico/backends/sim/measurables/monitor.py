"""What the photodiode in the head of a laser reads [mW]: the power that leaves it where its shutter is open."""

from __future__ import annotations

import math

from pico.backends.measured import Reading
from pico.backends.sim.lighted import standing_on
from pico.backends.sim.readings import Table
from pico.model.setup import Setup

NOISE = 0.001
"""Of a reading, as a share of it."""
LEAST = 1e-4
"""Of a reading in the dark [mW], one standard deviation."""


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the monitor of a source."""
    inside = component in setup.lab.inventory and measurable == "monitor"
    return inside and setup.type_of(component).optics.element == "source"


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the power with its standard deviation; the shutter stands behind the pick-off."""
    import numpy as np

    kind, values = table.setup.type_of(component), standing_on(table)[1].get(component, {})
    power = float(values.get("power", kind.number("power", "mW") or 0.0))
    power *= max(0.0, 1 + float(values.get("walk_power", 0.0))) if values.get("emission", True) else 0.0
    hidden = table.world.components[component].unseen
    power *= hidden.power if hidden is not None else 1.0  # dirt on the exit lies behind the pick-off
    noise = np.random.default_rng([table.world.seed, round(table.world.clock * 1000), *component.encode()])
    sigma = math.hypot(LEAST, NOISE * power)
    return Reading(power + sigma * float(noise.standard_normal()), sigma=sigma, saturated="")
