"""Set-points, read back."""

from __future__ import annotations

from pico.backends.attempt import Failed
from pico.backends.measured import Reading
from pico.backends.sim.readings import Table
from pico.diagnostics import error
from pico.model.setup import Setup


def measures(setup: Setup, component: str, measurable: str) -> bool:
    """Whether it is a tunable of a part."""
    return setup.measurables_of(component)[measurable].datatype == "setpoint"


def read(table: Table, component: str, measurable: str) -> Reading:
    """Return the value that the device reads."""
    live = table.world.components[component].values.get(measurable)
    if live is None or live.status != "known":
        address = f"{component}.{measurable}"
        hint = f"`pico do {component} home` finds out, where it is an axis"
        raise Failed(error("unread", f"{address} can't be read back: nobody knows it", hint=hint, address=address))
    return Reading(live.value)
