"""A beam through the middles of two irises: each is stopped down in turn while the other is wide open, and what comes
through both is made as much as can be."""

from __future__ import annotations

from pico.planning.asked import Asked, Ready
from pico.planning.nominal_bench import STEERS
from pico.planning.two_irises import in_order, two_irises

TAKES = "[MIRROR MIRROR] IRIS IRIS [DETECTOR]: the beam through both, by the light behind each in turn"
LEAST = 2


def make(asked: Asked) -> Ready:
    """Return the goal of two irises, with mirrors before and a detector behind that are found where they are not
    named."""
    words = [asked.part(word) for word in asked.words]
    irises = [w for w in words if asked.element(w) == "iris"]
    named = [w for w in words if asked.has(w, *STEERS)]
    if len(irises) != 2:
        raise asked.refused(f"it takes two irises, not {len(irises)}", f"through {TAKES}")
    pair = (irises[0], irises[1])
    mirrors = named or asked.mirrors_before(in_order(asked, pair)[0], 2)
    others = [w for w in words if w not in (*irises, *named)]
    tunables = {a: b for mirror in mirrors for a, b in asked.bounds(mirror, *STEERS).items()}
    return two_irises(asked, pair, tunables, others[-1] if others else None)
