"""What a power meter reads [mW], a photodiode behind its amplifier [V], and a balanced detector [V]: the difference of
what its two diodes take."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.lighted import detects, light_on, sightless, uncertain, unset
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is the power or the voltage of a detector with a single area, or the voltage of two diodes."""
    found = any(detects(setup, component, measurable, what) for what in ("power", "voltage"))
    kind = setup.type_of(component).parameters if found else {}
    return measurable == "voltage" if "separation" in kind else "active_diameter" in kind


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the reading with its standard deviation; unknown where the instrument is at its end."""
    from pico.optics.instruments import balanced_reading, power_reading
    from pico.optics.light import out_of_step

    light = light_on(table)
    part = light.parts.get(component)
    if part is None:
        raise Failed(error("missing", f"{component} does not stand on the table", address=component))
    if none := uncertain(light, component) or sightless(light, component):
        return none
    if why := out_of_step(light.at(component)):
        return Reading(None, unknown=f"what {component} would read is not known: {why}")
    reading = balanced_reading if "separation" in table.setup.type_of(component).parameters else power_reading
    found = reading(light.at(component), part, seed=table.world.seed, number=round(table.world.clock * 1000))
    if found.saturated:
        unit = table.setup.measurables_of(component)[measurable].unit
        why = f"{found.value:g} {unit} is all that it can tell".replace("  ", " ")
        return Reading(None, saturated=why, unknown=f"saturated: {why}")
    told = unset(light, component)
    return Reading(found.value, sigma=found.sigma, noise=found.noise, saturated="", conditions=told)
