"""Between the numbers of a lab's devices and the lab's own: in which units."""

from __future__ import annotations

from pico.model.instruments.conversion import Conversion, conversion
from pico.model.instruments.declaration import Declaration
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wired


def conversion_of(
    setup: Setup, about: Declaration, entry: DeviceEntry, component: str, name: str, wired: Wired
) -> Conversion:  # fmt: skip
    """Return how a property of a device becomes a tunable or measurable of a component."""
    kind, own = setup.type_of(component), about.unit(entry, wired.property)
    limits = about.limits(entry, wired.property)
    if tunable := kind.tunables.get(name):
        return conversion(wired, own, tunable.unit, limits=limits, range=tunable.range, period=tunable.period)
    return conversion(wired, own, setup.measurables_of(component)[name].unit, limits=limits)
