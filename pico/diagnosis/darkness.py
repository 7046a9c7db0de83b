"""Where light is lost that comes to some detectors no more: on the way to all these, and to none that it comes to."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from pico.diagnosis.nominal import Nominal
from pico.diagnosis.suspects import Suspect

NO_LIGHT, STOPS = "no light", "stops the light"
"""What has befallen a source, and any other part."""
FALLEN = -1.0
"""The change of the logarithm of what a monitor reads below which its source gives no light."""


def darkened(
    nominal: Nominal, dark: Collection[str], lit: Collection[str], monitors: Mapping[str, float]
) -> tuple[Suspect, ...]:
    """Return the parts of which each may keep the light from all detectors that are `dark`, in the order along the
    beam, equally likely. `lit`: detectors with light; `monitors`: by source, the change of the logarithm of what its
    own monitor reads."""
    ways = [nominal.way(name) for name in sorted(dark)]
    passed = {part for name in lit for part in nominal.way(name)}
    shared = [part for part in ways[0] if part not in passed and all(part in way for way in ways)] if ways else []
    fallen = [part for part in shared if monitors.get(part, 0.0) < FALLEN]
    left = fallen or [part for part in shared if part not in monitors]
    kinds = {part: nominal.setup.type_of(part).optics.element for part in left}
    return tuple(
        Suspect(part, NO_LIGHT if kinds[part] == "source" else STOPS, 1 / len(left), {}, {}, {},
                tuple(other for other in left if other != part))
        for part in left
    )  # fmt: skip
