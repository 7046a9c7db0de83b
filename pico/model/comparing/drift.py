"""Where the bench has left a state: what stands elsewhere, what nobody sees, and what can't be told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from pico.model.diff import (
    Change,
    describe_move,
    describe_value,
    diff_observed,
    place_json,
    show_value,
    slot_left,
)
from pico.model.observation import Observation, ObservedComponent, doubtful, slot_at
from pico.model.setup import Setup
from pico.model.state import LabState, place_of

NEAR = 100.0
"""A part that left a slot by less has moved; one that stands farther away was placed there [mm]."""


def drift_of(setup: Setup, seen: Observation, wanted: LabState) -> tuple[Change, ...]:
    """Return where the bench as observed has left `wanted`, as it happened, sorted by component: `after` is live.

    Light that the state asks for is none. A part that is missing, held or lies is a difference of its own; so is one
    that was seen less exactly than it must stand and of which nobody can therefore say that it is right.
    """
    off = (change for change in diff_observed(setup, seen, wanted) if not change.requested)
    found = [_happened(setup, seen, wanted, repair) for repair in off]
    beyond = {c.component for c in found if c.tunable == "pose" and not c.tolerated}
    unsure = [change for change in _unsure(setup, seen, wanted) if change.component not in beyond]
    names = {change.component for change in unsure}
    found = [c for c in found if c.tunable != "pose" or c.component not in names] + unsure
    return tuple(sorted(found, key=lambda c: (c.component, c.tunable)))


def _happened(setup: Setup, seen: Observation, wanted: LabState, repair: Change) -> Change:
    """Return how a bench got to where a change would bring it back from."""
    name, text = repair.component, ""
    if repair.tunable == "pose":
        (slot, goal), pose = place_of(setup, wanted, name), seen.components[name].pose
        assert pose is not None
        live = slot_left(setup, name, pose, goal)
        text = describe_move(slot if live or goal.distance(pose) > NEAR else None, goal, live, pose)
    elif repair.before is None:
        text = f"not known any more (was {show_value(repair.after)})"
    else:
        text = describe_value(setup.type_of(name).tunables[repair.tunable], repair.after, repair.before)
    return replace(repair, before=repair.after, after=repair.before, text=text)


def _unsure(setup: Setup, seen: Observation, wanted: LabState) -> Iterator[Change]:
    for name in sorted(setup.lab.inventory):
        slot, goal = place_of(setup, wanted, name)
        text = _text(setup, name, seen.components.get(name), slot)
        if text:
            where = f"in {slot}" if slot else f"at {goal}"
            yield Change(
                component=name, tunable="pose", before=place_json(slot, goal), text=f"{text}; it belongs {where}"
            )


def uncertain(setup: Setup, name: str, part: ObservedComponent, slot: str | None) -> bool:
    """Return whether a component was seen too badly to say that it stands where it belongs: in `slot`, where it is
    right anywhere, or at a pose (None)."""
    if part.pose is None or not doubtful(setup, name, part):
        return False
    return slot is None or slot_at(setup, part.pose) != slot


def _text(setup: Setup, name: str, part: ObservedComponent | None, slot: str | None) -> str:
    if part is not None and part.is_unlooked:
        return "unknown: no camera over the table can be used"
    if part is None or part.presence == "missing" or (part.pose is None and part.presence == "seen"):
        return "nobody sees it"
    if part.presence != "seen" or part.pose is None:
        return {"held": "is in a gripper", "toppled": "lies on its side"}.get(part.presence, part.presence)
    if not uncertain(setup, name, part, slot):
        return ""
    return f"uncertain: seen at {part.pose} ± {part.uncertainty.position:.2g} mm, {part.uncertainty.yaw:.2g}°"
