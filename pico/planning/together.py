"""Several arms at work at the same time: where two of them meet, one waits until the other is out of the way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass

from pico.geometry import disc, polygon, separation
from pico.model.lab import Setup
from pico.motion.types import MovePath
from pico.motion.zones import HAND, Zone, enters, shared_zones
from pico.planning.conflicts import Conflicts
from pico.planning.order import Closure, Turn, precedence, turns
from pico.planning.paths import Paths
from pico.planning.search import Step


@dataclass(frozen=True, slots=True)
class Meetings:
    """What arms that may meet must keep to. `waits`: which steps come after which others, or, for a negative number
    -1 - n, after the park of turn n. `zones`: the zones that each step holds, as resources."""

    waits: dict[int, tuple[int, ...]]
    zones: dict[int, tuple[str, ...]]
    parks: dict[int, tuple[str, ...]]


def meetings(setup: Setup, steps: Sequence[Step], paths: Paths) -> Meetings:
    """Return which steps of one arm must wait for another to leave the zone where they meet.

    An arm that keeps out of a zone can't touch the other, wherever that is. One that comes into it leaves it in its
    last move of the turn that does, where another follows, which then begins outside; else when it parks.
    """
    order = turns(steps)
    found = Meetings({}, {}, {})
    for zone in shared_zones(setup):
        name = "zone/" + "+".join(zone.robots)
        last: dict[str, int] = {}
        for n, turn in enumerate(order):
            if turn.robot not in zone.robots:
                continue
            inside = [k for k in turn.steps if _enters(setup, zone, paths.moves[k])]
            parks = _enters(setup, zone, paths.parks[n])
            other = next(r for r in zone.robots if r != turn.robot)
            for k in inside:
                found.zones[k] = (*found.zones.get(k, ()), name)
                found.waits[k] = (*found.waits.get(k, ()), *([last[other]] if other in last else []))
            if parks:
                found.parks[n] = (*found.parks.get(n, ()), name)
            if inside or parks:
                last[turn.robot] = -1 - n if parks else inside[-1]
    return found


def _enters(setup: Setup, zone: Zone, path: object) -> bool:
    """A park that has no path, and so is not made, leaves the arm where it is: then it may be anywhere."""
    return enters(setup, zone, path) if isinstance(path, MovePath) else True


def staggered(setup: Setup, table: Conflicts, steps: Sequence[Step]) -> tuple[Step, ...]:
    """Return the steps in an order in which arms hinder one another less: those of the first, third, ... turn that lie
    where arms meet come before the others of their turn, those of the second, fourth, ... after them."""
    zones, order = shared_zones(setup), turns(steps)
    if not zones or len(order) < 2:
        return tuple(steps)
    closure = precedence(table, steps, {})
    kept = [k for k, s in enumerate(steps) if s.hold.robot is None]
    if kept:
        return tuple(steps)  # what people do stands between turns; it keeps its place
    meeting = {k for k, s in enumerate(steps) if any(_near(table, z, s) for z in zones if s.hold.robot in z.robots)}
    return tuple(steps[k] for n, turn in enumerate(order) for k in _sorted(turn, closure, meeting, first=n % 2 == 0))


def _sorted(turn: Turn, closure: Closure, meeting: Set[int], *, first: bool) -> Iterator[int]:
    left = list(turn.steps)
    while left:
        free = [k for k in left if closure[k].isdisjoint(left)]
        k = min(free, key=lambda k: ((k in meeting) != first, k))
        left.remove(k)
        yield k


def _near(table: Conflicts, zone: Zone, step: Step) -> bool:
    mover = table.movers[step.mover]
    hand = max(HAND, mover.geometry.footprint.radius)
    poses = [mover.places[p].pose for p in (step.start, step.goal)]
    return any(separation(disc(p.x, p.y, hand), polygon(zone.corners)) <= 0.0 for p in poses)
