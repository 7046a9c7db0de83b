"""A beam through the middles of two irises: each is stopped down in turn while the other is wide open, and what comes
through both is made as much as can be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pico.model.goal import Budget, Goal
from pico.model.quantities import Value
from pico.planning.asked import Asked, Bounds, Ready
from pico.planning.openings import stopped_down, wide_open

_BUDGET = Budget(measurements=120, seconds=900.0)


def two_irises(asked: Asked, irises: tuple[str, str], tunables: Bounds, detector: str | None = None) -> Ready:
    """Return the goal of two irises by tunables of mirrors before them, named in the order of the beam, as `detector`
    sees it, the one behind both that suits best where none is named; where it is dark, light behind the nearer one is
    sought first, by the first mirror. Raises PicoError for what is missing."""
    for iris in irises:
        if not asked.has(iris, "opening"):
            raise asked.refused(f"{iris} has no motor for its opening", "`pico catalog show iris` has one")
    near, far = in_order(asked, irises)
    light = asked.light_of(detector or asked.meter_behind(far))
    one, other = asked.look("near"), asked.look("far")
    looks = {one: _looks(asked, near, [far]), other: _looks(asked, far, [near])}
    mirror = next(iter(tunables)).partition(".")[0]
    own = {address: bounds for address, bounds in tunables.items() if address.startswith(f"{mirror}.")}
    first = Goal(tunables=own, maximize=f"{one}.{light}", looks={one: looks[one]})
    whole = Goal(tunables=tunables, maximize=f"{one}.{light} * {other}.{light}", looks=looks, budget=_BUDGET)
    return Ready(asked.name, whole, ((f"light behind {near}", first),))


def in_order(asked: Asked, irises: Sequence[str]) -> tuple[str, str]:
    """Return two irises in the order in which a beam comes to them; raises PicoError where none comes to both."""
    for one, other in (irises, irises[::-1]):
        if any(one in way[:-1] for way in asked.ways(other)):
            return one, other
    text = f"no beam comes through {irises[0]} to {irises[1]}, nor the other way round"
    raise asked.refused(text, "`pico beam` shows where beams run")


def _looks(asked: Asked, closed: str, opened: Sequence[str]) -> Mapping[str, Value]:
    return {f"{closed}.opening": stopped_down(asked, closed), **{f"{o}.opening": wide_open(asked, o) for o in opened}}
