"""Why no light reaches a detector, as far as the bench says it: what is shut or off on its way, and what is missing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pico.model.goal import Goal
from pico.model.observation import Observation, slot_at
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import LabState, place_of
from pico.model.vocabulary import measured_in
from pico.optics.axis import Values, beams
from pico.planning.goal_light import standing_poses


def detects(setup: Setup, component: str) -> bool:
    """Return whether a component of the inventory reads light."""
    return component in setup.lab.inventory and setup.type_of(component).optics.element == "detector"


def darkness(setup: Setup, seen: Observation, wanted: LabState | None, detector: str) -> tuple[str, ...]:
    """Return what keeps light from a detector, in words: `laser.shutter is closed`, `m1 is in storage/b1`.

    If beams come to it by how parts stand, that is what shuts all of them; else those parts of the ways in the state
    `wanted` that do not stand on the table. Empty if the bench says neither.
    """
    known = seen.known_values
    ways = list(_ways(setup, standing_poses(seen), known, detector))
    if ways:
        shut = [tuple(_shut(known, way)) for way in ways]
        return tuple(dict.fromkeys(one for found in shut for one in found)) if all(shut) else ()
    if wanted is None:
        return ()
    meant = {name: place_of(setup, wanted, name) for name in setup.lab.inventory}
    placed = {name: pose for name, (slot, pose) in meant.items() if slot is None}
    along = [name for way in _ways(setup, placed, known, detector) for name in way]
    return tuple(gone for name in dict.fromkeys((*along, detector)) if (gone := _gone(setup, seen, name)))


def unlit(setup: Setup, seen: Observation, goal: Goal) -> str:
    """Return that no light reaches any detector that a goal reads, with what shuts it: `no light reaches cam:
    laser.shutter is closed`; empty if light may come, also where the goal itself opens something to look."""
    opened = {address.partition(".")[2] for look in (goal.looks or {}).values() for address in look}
    looks = goal.looks or ("",)
    named = dict.fromkeys(c for look in looks for c, _ in measured_in(setup, goal.seen_in(look)) if detects(setup, c))
    if not named or opened & {"shutter", "emission"}:
        return ""
    found = [darkness(setup, seen, None, name) for name in named]
    reasons = dict.fromkeys(one for some in found for one in some)
    return f"no light reaches {' or '.join(named)}: {', '.join(reasons)}" if all(found) else ""


def _ways(setup: Setup, poses: Mapping[str, Pose], values: Values, detector: str) -> Iterator[tuple[str, ...]]:
    """Yield the parts on each way from a source to a detector, whatever is shut."""
    for axis in beams(setup, poses, values):
        for way in axis.ways(detector):
            yield (axis.source, *(met.component for met in way))


def _shut(known: Values, way: tuple[str, ...]) -> Iterator[str]:
    """Yield what lets no light out along a way."""
    for name in way:
        own = known.get(name, {})
        if own.get("emission") is False:
            yield f"{name} is switched off"
        if own.get("shutter") == "closed":
            yield f"{name}.shutter is closed"


def _gone(setup: Setup, seen: Observation, name: str) -> str:
    """Return why a part does not stand on the table; empty if it does."""
    part = seen.components.get(name)
    if part is None or part.presence != "seen" or part.pose is None:
        return f"{name} is {part.presence if part else 'missing'}"
    slot = slot_at(setup, part.pose) if setup.movable(name) else None
    return f"{name} is in {slot}" if slot else ""
