"""As much light in a fiber as can be: by the two mirrors before it, and by its focus where a lens there moves along."""

from __future__ import annotations

from pico.bench.ready.tuning import ACROSS, ALONG, tuned
from pico.model.goal import Budget, Goal
from pico.planning.asked import Asked, Ready
from pico.planning.nominal_bench import STEERS

TAKES = "[PART...] COUPLER: as much light in it as can be, by two mirrors and a focus before it"
LEAST = 1


def make(asked: Asked) -> Ready:
    """Return the goal of a fiber; the mirrors and the lens before it are found where no parts are named."""
    coupler = asked.part(asked.words[-1])
    light = asked.light_of(coupler)
    if len(asked.words) > 1:
        tunables = dict(tuned(asked, (*ACROSS, *ALONG)))
    else:
        mirrors, way = asked.mirrors_before(coupler, 2), asked.way(coupler)
        tunables = {a: b for mirror in mirrors for a, b in asked.bounds(mirror, *STEERS).items()}
        last = way[way.index(mirrors[-1]) + 1 : -1]
        lens = next((n for n in reversed(last) if n and asked.element(n) == "lens" and asked.has(n, ALONG[0])), None)
        tunables |= asked.bounds(lens, ALONG[0]) if lens else {}
    return Ready(asked.name, Goal(tunables=tunables, maximize=light, budget=Budget(measurements=120, seconds=900.0)))
