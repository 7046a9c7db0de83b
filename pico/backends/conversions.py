"""Between the numbers of a lab's devices and the lab's own: which property is which tunable, in which units."""

from __future__ import annotations

from pico.model.instruments.conversion import Conversion, conversion
from pico.model.instruments.declaration import Declaration
from pico.model.instruments.kinds import kind_of
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wired


def mapped(setup: Setup, about: Declaration, entry: DeviceEntry, component: str) -> dict[str, Wired]:
    """Return the property of a device that each tunable and measurable of a component is: as `map` says, or else as
    its kind has it. Raises PicoError for a kind that there is not."""
    if entry.map:
        return dict(entry.map)
    kind = kind_of(about.kind)
    found = {name: Wired(property=of) for name, of in kind.usual.items()}
    if kind.by_name and component in setup.lab.inventory:
        own = setup.measurables_of(component).keys() & about.properties_of(entry).keys()
        found |= {name: Wired(property=name) for name in sorted(own)}
    return found


def conversion_of(
    setup: Setup, about: Declaration, entry: DeviceEntry, component: str, name: str, wired: Wired
) -> Conversion:  # fmt: skip
    """Return how a property of a device becomes a tunable or measurable of a component."""
    kind, own = setup.type_of(component), about.unit(entry, wired.property)
    limits = about.limits(entry, wired.property)
    if tunable := kind.tunables.get(name):
        return conversion(wired, own, tunable.unit, limits=limits, range=tunable.range, period=tunable.period)
    return conversion(wired, own, setup.measurables_of(component)[name].unit, limits=limits)
