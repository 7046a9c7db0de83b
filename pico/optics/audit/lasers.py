"""Which lasers shine, and of which class they are: by what they are set to, without following any light."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any, TypeGuard

from pico.model.arming import CLASSES, LaserClass
from pico.model.quantities import convert
from pico.model.setup import Setup
from pico.optics.audit.limits import EDGES, class_of
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
    """Return the class of a laser with these tunables, and its power [mW]. A tunable that was not read back counts as
    whatever it may be: the power as the highest of its range, the wavelength as the most dangerous one."""
    power = max(_may_be(setup, laser, values, "power", "mW", 1.0))
    of = (class_of(power, wavelength) for wavelength in _may_be(setup, laser, values, "wavelength", "nm", 632.8))
    return max(of, key=CLASSES.index), power


def unread_power(setup: Setup, laser: str, values: Mapping[str, Any]) -> float | None:
    """Return the highest power that a laser may have, in the unit of its tunable, if it can be set and was not read
    back; else None."""
    tunable = setup.type_of(laser).tunables.get("power")
    return tunable.range[1] if tunable is not None and tunable.range and not _number(values.get("power")) else None


def _may_be(
    setup: Setup, laser: str, values: Mapping[str, Any], name: str, unit: str, otherwise: float
) -> tuple[float, ...]:  # fmt: skip
    """Return what a property of a laser may be, in a unit: one value if it is known, else the ends of its range and
    of wavelengths those at which limits change, from either side."""
    kind, own = setup.type_of(laser), values.get(name)
    tunable, found = kind.tunables.get(name), kind.number(name, unit)
    if tunable is None:
        return (otherwise if found is None else found,)
    numbers = (own,) if _number(own) else tunable.range or (math.inf,)
    known = tuple(
        float(convert(f"{n!r} {tunable.unit}", unit))
        if tunable.unit not in ("", unit) and math.isfinite(n)
        else float(n)
        for n in numbers
    )
    if name != "wavelength":
        return known
    inside = (edge for edge in EDGES if min(known) <= edge <= max(known))
    sides = (near for edge in inside for near in (math.nextafter(edge, 0), edge, math.nextafter(edge, math.inf)))
    return (*known, *(near for near in sides if min(known) < near < max(known)))


def _number(value: object) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)
