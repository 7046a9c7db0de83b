"""The output of a balanced detector [V]: the difference of what its two diodes take."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.lighted import detects, light_on
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the voltage of two diodes."""
    return detects(setup, component, measurable, "voltage") and "separation" in setup.type_of(component).parameters


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the voltage with its standard deviation; unknown where the amplifier is at its end."""
    from pico.optics.instruments import balanced_reading
    from pico.optics.light import out_of_step

    light = light_on(table)
    part = light.parts.get(component)
    if part is None:
        raise Failed(error("missing", f"{component} does not stand on the table", address=component))
    if why := out_of_step(light.at(component)):
        return Reading(None, unknown=f"what {component} would read is not known: {why}")
    found = balanced_reading(
        light.at(component), part, seed=table.world.seed, number=round(table.world.clock * 1000)
    )  # fmt: skip
    if found.saturated:
        why = f"{found.value:g} V is all that it can tell"
        return Reading(None, saturated=why, unknown=f"saturated: {why}")
    return Reading(found.value, sigma=found.sigma, saturated="")
