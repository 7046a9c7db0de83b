"""Irradiance on parts against what they stand.

It is that on the axis of a Gaussian beam, 2 P / (pi w_x w_y), each beam by itself, as if it came square: never less
than what is there of one beam. Against it stands the parameter `damage_threshold` of a part's type, for continuous
light.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from pico.optics.audit.branches import Branches
from pico.optics.audit.findings import Finding
from pico.optics.following import Crossing

UNIT = "mW/mm^2"


def damaged(branches: Branches) -> Iterator[Finding]:
    """Yield a finding for each part that a beam may destroy, of the strongest beam on it."""
    worst: dict[str, tuple[float, int]] = {}
    for number, crossing in enumerate(branches.light.crossings):
        part = branches.part(crossing)
        threshold = part.kind.number("damage_threshold", UNIT) if part else None
        if threshold is not None and crossing.event != "blocked" and (strong := irradiance(crossing)) > threshold:
            worst[crossing.component] = max(worst.get(crossing.component, (0.0, 0)), (strong, number))
    for name, (strong, number) in sorted(worst.items()):
        part = branches.light.parts[name]
        limit = part.kind.number("damage_threshold", UNIT)
        hint = f"weaken the beam before {name}, or widen it there"
        yield branches.finding("damage", number, f"damages {name}", strong, limit=limit, hint=hint)


def irradiance(crossing: Crossing) -> float:
    """Return the irradiance on the axis of a beam as it arrives [mW/mm2]."""
    wide, narrow, _ = crossing.beam.widths
    return 2 * crossing.power / (math.pi * wide * narrow)


def unjudged(branches: Branches) -> Iterator[str]:
    """Yield the parts in beams above the limit that give no threshold; a block takes what it says it does."""
    for crossing in branches.light.crossings:
        part = branches.part(crossing)
        if part is None or part.kind.optics.element in ("block", "source") or crossing.event == "blocked":
            continue
        if crossing.power > branches.harmless and "damage_threshold" not in part.kind.parameters:
            yield part.name
