"""What to write into a state, and what a live bench changes in it: only what differs beyond tolerance, rounded."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pico.model.address import Named, holds
from pico.model.catalog import Tunable
from pico.model.diff import value_distance
from pico.model.lab import Setup
from pico.model.observation import slot_at
from pico.model.pose import Pose, angle_between
from pico.model.quantities import Value
from pico.model.state import ComponentState, LabState, place_of

Change = Value | Pose | None
"""A new value: of a tunable, of `slot` (its name) or of `pose`. None takes the entry out."""
Changes = Mapping[str, Mapping[str, Change] | None]
"""For each component the entries that change; None takes the whole component out."""


def differences(
    setup: Setup, wanted: LabState, live: LabState, named: Named | None = None
) -> dict[str, dict[str, Change]]:
    """Return for each component the entries to write so that `wanted` says what `live` is.

    A component that `live` lacks (not seen) and one that the inventory lacks stay as they are; tunables that `wanted`
    does not name stay unnamed, except of a component that it does not name at all. `named`: only these tunables.
    """
    changes: dict[str, dict[str, Change]] = {}
    for name in sorted(live.components.keys() & setup.lab.inventory.keys()):
        seen = live.components[name]
        entries = _place(setup, name, wanted, seen)
        if name in wanted.components:
            entries |= _values(setup, name, wanted.components[name], seen)
        elif entries:
            entries |= {k: rounded(setup, name, k, v) for k, v in sorted(seen.values.items()) if _known(setup, name, k)}
        if named is not None:
            entries = {k: v for k, v in entries.items() if holds(named, name, "pose" if k == "slot" else k)}
        if entries:
            changes[name] = entries
    return changes


def _known(setup: Setup, name: str, tunable: str) -> bool:
    return tunable in setup.type_of(name).tunables


def _place(setup: Setup, name: str, wanted: LabState, seen: ComponentState) -> dict[str, Change]:
    slot, goal = place_of(setup, wanted, name)
    if seen.slot:
        # A pose that lies in the slot's capture radius is as right as the slot's name.
        same = slot == seen.slot or (slot is None and slot_at(setup, goal) == seen.slot)
        return {} if same else {"slot": seen.slot}
    if seen.pose is None:
        return {}
    kind = setup.type_of(name).pose
    step = kind.resolution
    exact = Pose(
        _round(seen.pose.x, step.position), _round(seen.pose.y, step.position), _round(seen.pose.yaw, step.yaw)
    )
    if slot is not None:
        return {"pose": exact}
    moved = goal.distance(seen.pose) > kind.tolerance.position
    turned = abs(angle_between(goal.yaw, seen.pose.yaw)) > kind.tolerance.yaw
    # Of a component that moved along x only, y stays as it is written: each axis within its share of the tolerance.
    share = kind.tolerance.position / math.sqrt(2)
    pose = Pose(
        exact.x if moved and abs(goal.x - seen.pose.x) > share else goal.x,
        exact.y if moved and abs(goal.y - seen.pose.y) > share else goal.y,
        exact.yaw if turned else goal.yaw,
    )
    return {"pose": pose} if moved or turned else {}


def _values(setup: Setup, name: str, wanted: ComponentState, seen: ComponentState) -> dict[str, Change]:
    kinds = setup.type_of(name).tunables
    return {
        tunable: rounded(setup, name, tunable, seen.values[tunable])
        for tunable, goal in sorted(wanted.values.items())
        if tunable in seen.values and tunable in kinds and _differs(kinds[tunable], goal, seen.values[tunable])
    }


def _differs(kind: Tunable, goal: Value, live: Value) -> bool:
    return value_distance(kind, goal, live) > kind.tolerance


def rounded(setup: Setup, name: str, tunable: str, value: Value) -> Value:
    """Return a value rounded to the resolution that its type declares."""
    if isinstance(value, bool | str):
        return value
    return _round(value, setup.type_of(name).tunables[tunable].resolution)


def _round(value: float, step: float) -> float:
    if step <= 0:
        return round(value, 6)
    return round(round(value / step) * step, max(0, 3 - math.floor(math.log10(step)))) + 0.0
