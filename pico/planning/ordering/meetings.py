"""Where arms meet: who waits for whom to leave before it comes in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from pico.model.setup import Setup
from pico.motion.types import Blocked, MovePath
from pico.motion.zones import MARGIN, Zone, enters, shared_zones
from pico.planning.ordering.order import turns
from pico.planning.ordering.paths import Park, Paths
from pico.planning.ordering.search import OrderedMove


@dataclass(frozen=True, slots=True)
class Item:
    """A step or a park in the order of a plan, the zones that it holds as resources, and the items that it waits for
    because they are where it comes."""

    robot: str | None
    step: int | None = None
    park: Park | None = None
    zones: tuple[str, ...] = ()
    waits: tuple[int, ...] = ()


def items(setup: Setup, steps: Sequence[OrderedMove], paths: Paths | None) -> tuple[Item, ...]:
    """Return steps and parks in an order that works, each with the zones where it keeps others out.

    An arm that keeps out of a zone can't touch the other, wherever that is. One that comes into it leaves it with a
    later move, or parks; then the other may come in. Without paths nobody knows where an arm comes, and they take
    turns all over the table.
    """
    parks = paths.parks if paths else _turns(steps)
    zones = shared_zones(setup) if paths else ()
    inside: Mapping[str, tuple[str, ...]]
    found: list[Item] = []
    last: dict[tuple[str, str], int] = {}
    for item in _listed(steps, parks):
        path = item.park.path if item.park else paths.moves[item.step or 0] if paths else None
        inside = {z.name: z.robots for z in zones if item.robot in z.robots and _enters(setup, z, path)}
        if not paths and len(setup.lab.robots) > 1 and item.robot:
            inside = {"arms": tuple(sorted(setup.lab.robots))}
        waits = {last[n, r] for n, rs in inside.items() for r in rs if r != item.robot and (n, r) in last}
        last |= {(n, item.robot or ""): len(found) for n in inside}
        found.append(replace(item, zones=tuple(inside), waits=tuple(sorted(waits))))
    return tuple(found)


def _listed(steps: Sequence[OrderedMove], parks: Sequence[Park]) -> Iterator[Item]:
    for k, step in enumerate(steps):
        yield from (Item(p.robot, park=p) for p in parks if p.before == k)
        yield Item(step.hold.robot, step=k)
    yield from (Item(p.robot, park=p) for p in parks if p.before is None)


def _turns(steps: Sequence[OrderedMove]) -> tuple[Park, ...]:
    """Return the parks where each arm parks before another has its turn."""
    order = turns(steps)
    following = (*(turn.steps[0] for turn in order[1:]), None)
    return tuple(Park(turn.robot, turn.steps, k) for turn, k in zip(order, following, strict=False))


def _enters(setup: Setup, zone: Zone, path: MovePath | Blocked | None) -> bool:
    """A park that has no path, and so is not made, leaves the arm where it is: then it may be anywhere."""
    return enters(setup, zone, path, MARGIN) if isinstance(path, MovePath) else True
