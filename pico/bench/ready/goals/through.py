"""A beam through the middles of two irises: each is stopped down in turn while the other is wide open, and what comes
through both is made as much as can be."""

from __future__ import annotations

from collections.abc import Sequence

from pico.bench.ready.asked import Asked, Ready
from pico.bench.ready.openings import stopped_down, wide_open
from pico.model.lab import Budget, Goal
from pico.model.quantities import Value
from pico.planning.nominal_bench import STEERS

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
    for iris in irises:
        if not asked.has(iris, "opening"):
            raise asked.refused(f"{iris} has no motor for its opening", "`pico catalog show iris` has one")
    near, far = _in_order(asked, irises)
    mirrors = named or asked.mirrors_before(near, 2)
    others = [w for w in words if w not in (*irises, *named)]
    light = asked.light_of(others[-1] if others else asked.meter_behind(far))
    one, other = asked.look("near"), asked.look("far")
    looks = {one: _looks(asked, near, [far]), other: _looks(asked, far, [near])}
    tunables = {a: b for mirror in mirrors for a, b in asked.bounds(mirror, *STEERS).items()}
    first = Goal(tunables=asked.bounds(mirrors[0], *STEERS), maximize=f"{one}.{light}", looks={one: looks[one]})
    whole = Goal(
        tunables=tunables, maximize=f"{one}.{light} * {other}.{light}", looks=looks,
        budget=Budget(measurements=120, seconds=900.0),
    )  # fmt: skip
    return Ready(asked.name, whole, ((f"light behind {near}", first),))


def _in_order(asked: Asked, irises: Sequence[str]) -> tuple[str, str]:
    for one, other in (irises, irises[::-1]):
        if any(one in way[:-1] for way in asked.ways(other)):
            return one, other
    text = f"no beam comes through {irises[0]} to {irises[1]}, nor the other way round"
    raise asked.refused(text, "`pico beam` shows where beams run")


def _looks(asked: Asked, closed: str, opened: Sequence[str]) -> dict[str, Value]:
    return {f"{closed}.opening": stopped_down(asked, closed), **{f"{o}.opening": wide_open(asked, o) for o in opened}}
