"""Which lasers shine, and of which class they are: by what they are set to, without following any light."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from pico.model.arming import LaserClass
from pico.model.quantities import convert
from pico.model.setup import Setup
from pico.optics.audit.limits import class_of
from pico.optics.axis import Values


def shines(setup: Setup, laser: str, values: Mapping[str, Any]) -> bool:
    """Return whether a laser with these tunables lets light out; one that has no `emission` is on, and a shutter that
    nobody knows counts as open."""
    kind = setup.type_of(laser)
    emits = "emission" not in kind.tunables or values.get("emission") is True
    return emits and values.get("shutter") != "closed"


def lasers_of(setup: Setup, poses: Collection[str], values: Values) -> tuple[str, ...]:
    """Return the lasers among what stands at `poses` that shine, by name."""
    sources = (n for n in sorted(poses) if setup.type_of(n).optics.element == "source")
    return tuple(n for n in sources if shines(setup, n, values.get(n, {})))


def laser_class(setup: Setup, laser: str, values: Mapping[str, Any]) -> tuple[LaserClass, float]:
    """Return the class of a laser with these tunables, and its power [mW]."""
    kind = setup.type_of(laser)

    def number(name: str, unit: str, otherwise: float) -> float:
        own, tunable = values.get(name), kind.tunables.get(name)
        if tunable is not None and isinstance(own, int | float) and not isinstance(own, bool):
            return float(convert(f"{own!r} {tunable.unit}", unit)) if tunable.unit not in ("", unit) else float(own)
        found = kind.number(name, unit)
        return otherwise if found is None else found

    power = number("power", "mW", 1.0)
    return class_of(power, number("wavelength", "nm", 632.8)), power
