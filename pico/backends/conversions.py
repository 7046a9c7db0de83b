"""Between the numbers of a lab's devices and the lab's own: which property is which tunable, in which units."""

from __future__ import annotations

from pico.model.instruments.conversion import Conversion, conversion
from pico.model.instruments.declaration import Declaration
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wired

USUAL = {"shutter": "shutter", "laser": "emission", "lamp": "illumination", "power meter": "power"}
"""The tunable or measurable that a kind of instrument is where its `map` says nothing."""
OWN = {"shutter": "open", "laser": "emission", "lamp": "on", "power meter": "power"}
"""The property of a kind of instrument that is this tunable or measurable."""


def mapped(setup: Setup, about: Declaration, entry: DeviceEntry, component: str) -> dict[str, Wired]:
    """Return the property of a device that each tunable and measurable of a component is: as `map` says, or else the
    usual one of the kind, and of a meter the wavelength that it is told."""
    if entry.map or about.kind not in USUAL:
        return dict(entry.map)
    found = {USUAL[about.kind]: Wired(property=OWN[about.kind])}
    if about.kind == "power meter" and component in setup.lab.inventory:
        own = setup.type_of(component).tunables.keys() & {"wavelength"} & about.properties.keys()
        found |= {name: Wired(property=name) for name in own}
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
