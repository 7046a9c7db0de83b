"""What to write into a state, and what a live bench changes in it: only what differs beyond tolerance, rounded."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pico.model.address import Named, holds
from pico.model.diff import deviation, value_deviation
from pico.model.observation import slot_at
from pico.model.pose import Pose, angle_between
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, place_of

Change = Value | Pose | Mapping[str, Any] | None
"""A new value: of a tunable (a reference to light as data), of `slot` (its name) or of `pose`. None takes the entry
out."""
NONE: Mapping[str, Value] = {}
Changes = Mapping[str, Mapping[str, Change] | None]
"""For each component the entries that change; None takes the whole component out."""


def differences(
    setup: Setup, wanted: LabState, live: LabState, named: Named | None = None, found: Mapping[str, Value] = NONE
) -> dict[str, dict[str, Change]]:
    """Return for each component the entries to write so that `wanted` says what `live` is.

    A component that `live` lacks (not seen) and one that the inventory lacks stay as they are; tunables that `wanted`
    does not name stay unnamed, except of a component that it does not name at all. `named`: only these tunables. Light
    that is asked for stays asked for, unless it is named. `found`: values that light found, by address, which are
    written down to the resolution, also those that `wanted` does not name.
    """
    changes: dict[str, dict[str, Change]] = {}
    for name in sorted(live.components.keys() & setup.lab.inventory.keys()):
        seen = live.components[name]
        entries = _place(setup, name, wanted, live)
        light = {a.partition(".")[2] for a in found if a.partition(".")[0] == name} & seen.values.keys()
        if name in wanted.components:
            values = _values(setup, name, wanted.components[name], seen, found)
            entries |= {k: v for k, v in values.items() if named is not None or not setup.requests(name, k)}
        elif entries:
            entries |= {k: rounded(setup, name, k, v) for k, v in sorted(seen.values.items()) if _known(setup, name, k)}
        elif light:
            home = setup.lab.inventory[name].home
            entries |= {k: rounded(setup, name, k, seen.values[k]) for k in sorted(light)}
            entries |= {"slot": home} if home else {}
        if named is not None:
            entries = {k: v for k, v in entries.items() if holds(named, name, "pose" if k == "slot" else k)}
        if entries:
            changes[name] = entries
    return changes


def asked_for(setup: Setup, wanted: LabState, goal: LabState, named: Named) -> Changes:
    """Return for each component that is `named` the entries to write so that `wanted` says of it what `goal` does:
    in the form that it has there, and however near that is, down to the resolution."""
    neat = {n: _neat(setup, n, p, wanted.components.get(n)) for n, p in goal.components.items() if n in named}
    then = replace(goal, components={**goal.components, **neat})
    made = {name: entries(setup, name, some, then, wanted) for name, some in sorted(named.items())}
    home = {name: {"slot": setup.lab.inventory[name].home} for name in made.keys() - wanted.components.keys()}
    return {name: change for name, change in made.items() if change not in ({}, home.get(name))}


def entries(
    setup: Setup, name: str, some: frozenset[str] | None, then: LabState, now: LabState
) -> Mapping[str, Change] | None:
    """Return the entries of a component to write for it, or for `some` of its tunables, to be as `then`.

    None takes the component out of the manifest, which brings it home.
    """
    was, is_ = then.components.get(name), now.components.get(name)
    if was is None and some is None:
        return None if is_ else {}
    made: dict[str, Change] = {}
    if some is None or "pose" in some:
        made |= _exact_place(setup, name, was, is_)
    values, old = (part.given if part else {} for part in (was, is_))
    for tunable in sorted(values.keys() | old.keys()):
        if holds({name: some}, name, tunable) and values.get(tunable) != old.get(tunable):
            made[tunable] = values.get(tunable)
    home = setup.lab.inventory[name].home
    if made and is_ is None and home and not made.keys() & {"slot", "pose"}:
        made["slot"] = home
    return made


def _exact_place(setup: Setup, name: str, was: ComponentState | None, is_: ComponentState | None) -> dict[str, Change]:
    home = setup.lab.inventory[name].home
    slot = was.slot if was else home
    pose = was.pose if was else None
    if slot:
        return {} if is_ and is_.slot == slot else {"slot": slot}
    if pose:
        return {} if is_ and is_.pose == pose else {"pose": pose}
    return {"pose": None} if is_ and is_.pose else {}


def _neat(setup: Setup, name: str, part: ComponentState, now: ComponentState | None) -> ComponentState:
    """Return a component with its numbers rounded to their resolution; axes of its pose that are as `now` stay so."""
    values = {k: rounded(setup, name, k, v) if _known(setup, name, k) else v for k, v in part.values.items()}
    if part.pose is None:
        return replace(part, values=values)
    step, there = setup.type_of(name).pose.resolution, now.pose if now else None

    def neat(axis: str, fine: float) -> float:
        asked, has = getattr(part.pose, axis), getattr(there, axis, math.inf)
        return float(has if abs(has - asked) < fine / 2 else _round(asked, fine))

    pose = Pose(neat("x", step.position), neat("y", step.position), neat("yaw", step.yaw))
    return replace(part, values=values, pose=pose)


def _known(setup: Setup, name: str, tunable: str) -> bool:
    return tunable in setup.type_of(name).tunables


def _place(setup: Setup, name: str, wanted: LabState, seen: LabState) -> dict[str, Change]:
    """Return what to write of a place, in the form that is wanted: a slot becomes a pose only where the part is in
    none, a pose never a slot, which would say less."""
    if not (seen.components[name].slot or seen.components[name].pose):
        return {}
    (slot, goal), (_, live) = place_of(setup, wanted, name), place_of(setup, seen, name)
    if deviation(setup, name, live, slot, goal) != "off":
        return {}
    if slot is None:
        return {"pose": _posed(setup, name, goal, live)}
    other = slot_at(setup, live) if setup.movable(name) else None
    return {"slot": other} if other else {"pose": _posed(setup, name, None, live)}


def _posed(setup: Setup, name: str, goal: Pose | None, live: Pose) -> Pose:
    """Return a pose rounded to its resolution, as far as that is within tolerance; axes of the `goal` that are stay."""
    kind = setup.type_of(name).pose
    step, most = kind.resolution, kind.tolerance
    pose = Pose(_round(live.x, step.position), _round(live.y, step.position), _round(live.yaw, step.yaw))
    if goal is not None:
        # Of a component that moved along x only, y stays as it is written: each axis within its share of the tolerance.
        share = most.position / math.sqrt(2) if goal.distance(live) > most.position else math.inf
        pose = Pose(
            pose.x if abs(goal.x - live.x) > share else goal.x,
            pose.y if abs(goal.y - live.y) > share else goal.y,
            pose.yaw if abs(angle_between(goal.yaw, live.yaw)) > most.yaw else goal.yaw,
        )
    return live if deviation(setup, name, live, None, pose) == "off" else pose


def _values(
    setup: Setup, name: str, wanted: ComponentState, seen: ComponentState, found: Mapping[str, Value]
) -> dict[str, Change]:
    kinds, changes = setup.type_of(name).tunables, dict[str, Change]()
    for tunable, goal in sorted(wanted.values.items()):
        if tunable not in seen.values or tunable not in kinds:
            continue
        kind, live, address = kinds[tunable], seen.values[tunable], f"{name}.{tunable}"
        off, written = value_deviation(kind, live, goal), rounded(setup, name, tunable, live)
        # what is read of a motor scatters by less than its tolerance: only what a search found anew is written again
        anew = off == "tolerated" and address in found and value_deviation(kind, found[address], goal) != "none"
        if off == "off" or (anew and written != goal):
            changes[tunable] = written
    for tunable in sorted(kinds.keys() & seen.values.keys() - wanted.given.keys()):
        if f"{name}.{tunable}" in found:
            changes[tunable] = rounded(setup, name, tunable, seen.values[tunable])
    return changes


def rounded(setup: Setup, name: str, tunable: str, value: Value) -> Value:
    """Return a value rounded to the resolution that its type declares, as far as that is within tolerance."""
    if isinstance(value, bool | str):
        return value
    kind = setup.type_of(name).tunables[tunable]
    near = _round(value, kind.resolution)
    return value if value_deviation(kind, value, near) == "off" else near


def _round(value: float, step: float) -> float:
    if step <= 0:
        return round(value, 6)
    return round(round(value / step) * step, max(0, 3 - math.floor(math.log10(step)))) + 0.0
