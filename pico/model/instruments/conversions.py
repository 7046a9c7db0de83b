"""Between the numbers of a lab's devices and the lab's own: in which units, with which zero and direction."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Protocol

from pico.model.instruments.conversion import Conversion, conversion
from pico.model.instruments.declaration import Declaration
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry, Wired


class Correction(Protocol):
    """Direction and zero of an axis as they were calibrated."""

    def corrects(self, conversion: Conversion) -> Conversion:
        """Return a conversion with direction and zero put right."""
        ...


def conversion_of(
    setup: Setup, about: Declaration, entry: DeviceEntry, component: str, name: str, wired: Wired,
    axes: Mapping[str, Correction] = MappingProxyType({}),
) -> Conversion:  # fmt: skip
    """Return how a property of a device becomes a tunable or measurable of a component; `axes`: direction and zero as
    they were calibrated, by the address of the tunable."""
    kind, own = setup.type_of(component), about.unit(entry, wired.property)
    limits = about.limits(entry, wired.property)
    if tunable := kind.tunables.get(name):
        made = conversion(wired, own, tunable.unit, limits=limits, range=tunable.range, period=tunable.period)
        axis = axes.get(f"{component}.{name}")
        return made if axis is None else axis.corrects(made)
    return conversion(wired, own, setup.measurables_of(component)[name].unit, limits=limits)
