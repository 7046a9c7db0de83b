"""The physical diff: which tunables differ between two states, as motions a person can picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Literal

from pico.model.catalog import Tunable
from pico.model.observation import Aligned, Observation, slot_at
from pico.model.pose import Pose, angle_between, short
from pico.model.quantities import Value
from pico.model.record import as_json, record
from pico.model.setup import Setup
from pico.model.state import LabState, is_reference, place_of
from pico.model.state import said as by_light

Deviation = Literal["none", "tolerated", "off"]


@record
class Change:
    """One tunable that differs. `before` and `after` hold a slot's name, a pose as {x, y, yaw}, or a value; `before`
    is None where it is not known. `tolerated`: it differs by no more than its tolerance, so nothing moves for it; or
    light has the last word on it, and it stays at its live value (`aligned`). `requested`: it is light that is asked
    for, which no state is: the bench equals the state nevertheless."""

    component: str
    tunable: str
    before: Any = None
    after: Any = None
    text: str = ""
    tolerated: bool = False
    requested: bool | None = None
    aligned: Aligned | None = None

    @property
    def counts(self) -> bool:
        """Whether two states are not the same because of it."""
        return not (self.tolerated or self.requested)


def addresses_of(changes: Sequence[Change], most: int = 4) -> str:
    """Return which tunables some changes are of, the first by address: `p2, p1.angle and 3 more`."""
    names = [c.component if c.tunable == "pose" else f"{c.component}.{c.tunable}" for c in changes]
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def place_json(slot: str | None, pose: Pose) -> Any:
    """Return a place as a change shows it: the slot's name where it is in one, else the pose."""
    return slot if slot else as_json(pose)


def diff_states(setup: Setup, a: LabState, b: LabState) -> tuple[Change, ...]:
    """Return what differs from state `a` to state `b`, exactly, sorted by component and tunable.

    A component of either state that the inventory lacks is compared by what the states say alone.
    """
    changes: list[Change] = []
    for name in sorted(a.components.keys() | b.components.keys() | setup.lab.inventory.keys()):
        if name not in setup.lab.inventory:
            if name not in a.components or name not in b.components:
                text = "added" if name in b.components else "removed"
                changes.append(Change(component=name, tunable="pose", text=f"{text} (not in the inventory)"))
            continue
        (slot_a, pose_a), (slot_b, pose_b) = place_of(setup, a, name), place_of(setup, b, name)
        if (slot_a, pose_a) != (slot_b, pose_b):
            before, after = place_json(slot_a, pose_a), place_json(slot_b, pose_b)
            text = describe_move(slot_a, pose_a, slot_b, pose_b)
            changes.append(Change(component=name, tunable="pose", before=before, after=after, text=text))
        values_a = a.components[name].given if name in a.components else {}
        values_b = b.components[name].given if name in b.components else {}
        for tunable in sorted(values_a.keys() | values_b.keys()):
            before, after = values_a.get(tunable), values_b.get(tunable)
            if before != after:
                kind = setup.type_of(name).tunables.get(tunable, Tunable())
                text = describe_value(kind, before, after)
                asked = kind.restore.kind == "request" or None
                changes.append(Change(
                    component=name, tunable=tunable, before=before, after=after, text=text, requested=asked
                ))  # fmt: skip
    return tuple(changes)


def diff_observed(setup: Setup, seen: Observation, wanted: LabState, *, exact: bool = False) -> tuple[Change, ...]:
    """Return what must change for the bench as observed to be as wanted, sorted by component and tunable.

    Differences below the resolution are none; those within tolerance are listed as `tolerated` unless `exact`, and so
    are those of tunables that stay where light has them (`seen.aligned`). Missing, held and toppled components are
    left to the caller; tunables that the observation does not hold are not compared.
    """
    changes: list[Change] = []
    for name in sorted(setup.lab.inventory):
        part = seen.components.get(name)
        if part is None or part.pose is None or part.presence != "seen":
            continue
        move = _observed_move(setup, name, part.pose, wanted, exact)
        if move:
            changes.append(move)
        changes.extend(_observed_values(setup, name, seen, wanted, exact))
    return tuple(changes)


def deviation(setup: Setup, name: str, pose: Pose, slot: str | None, goal: Pose) -> Deviation:
    """Return how far a part that stands at `pose` is off the place where it belongs: a slot, which is right anywhere in
    its capture radius and at any yaw, or a pose, of which only the pose counts, slot or not."""
    if slot is not None and slot_at(setup, pose) == slot:
        return "none"
    kind = setup.type_of(name).pose
    away, turned = pose.distance(goal), abs(angle_between(pose.yaw, goal.yaw))
    if away < kind.resolution.position and turned < kind.resolution.yaw:
        return "none"
    within = slot is None and away <= kind.tolerance.position and turned <= kind.tolerance.yaw
    return "tolerated" if within else "off"


def unread_values(seen: Observation, wanted: LabState) -> tuple[str, ...]:
    """Return the tunables, by address, that a state gives a value and that no device of the bench reads: they are
    compared with nothing."""
    return tuple(sorted(
        f"{name}.{tunable}" for name, part in wanted.components.items() if name in seen.components
        for tunable in part.values.keys() - seen.components[name].values.keys()
    ))  # fmt: skip


def _observed_move(setup: Setup, name: str, pose: Pose, wanted: LabState, exact: bool) -> Change | None:
    slot, goal = place_of(setup, wanted, name)
    off = deviation(setup, name, pose, slot, goal)
    if off == "none":
        return None
    live = slot_left(setup, name, pose, goal)
    return Change(
        component=name,
        tunable="pose",
        before=place_json(live, pose),
        after=place_json(slot, goal),
        text=describe_move(live, pose, slot, goal),
        tolerated=off == "tolerated" and not exact,
    )


def slot_left(setup: Setup, name: str, pose: Pose, goal: Pose) -> str | None:
    """Return the slot that a part at `pose` leaves for `goal`; None where it is in none, or stays in it."""
    slot = slot_at(setup, pose) if setup.movable(name) else None
    return None if slot == slot_at(setup, goal) else slot


def _observed_values(setup: Setup, name: str, seen: Observation, wanted: LabState, exact: bool) -> list[Change]:
    changes, part = [], seen.components[name]
    state = wanted.components.get(name)
    for tunable, goal in sorted(state.values.items()) if state else ():
        kind = setup.type_of(name).tunables.get(tunable)
        live = part.values.get(tunable)
        if kind is None or live is None or kind.restore.kind == "none":
            continue
        value = None if live.status == "unknown" else live.value
        off = "off" if value is None else value_deviation(kind, value, goal)
        if off == "none":
            continue
        stays = value is not None and off == "off" and not exact
        met = (seen.aligned or {}).get(f"{name}.{tunable}") if stays else None
        text = describe_value(kind, value, goal)
        changes.append(
            Change(
                component=name,
                tunable=tunable,
                before=value,
                after=goal,
                text=text,
                tolerated=(off == "tolerated" or met is not None) and not exact,
                aligned=met,
                requested=kind.restore.kind == "request" or None,
            )
        )
    return changes


def within_trim(kind: Tunable, value: Value, goal: Value) -> bool:
    """Return whether a tunable that light has the last word on is within its trim of the value that is committed:
    farther away, its part was probably put down badly."""
    trim = kind.restore.trim
    return kind.restore.kind == "align" and trim is not None and value_distance(kind, value, goal) <= trim


def value_deviation(kind: Tunable, value: Value, goal: Value) -> Deviation:
    """Return how far a tunable that has `value` is off the one that is wanted."""
    apart = value_distance(kind, value, goal)
    if value == goal or apart < max(kind.resolution, 1e-9):
        return "none"
    return "tolerated" if apart <= kind.tolerance else "off"


def value_distance(kind: Tunable, a: Value, b: Value) -> float:
    """Return how far two values of a tunable lie apart, in its unit; infinite where they are not numbers and differ.

    Values of a tunable with a period count around it.
    """
    if isinstance(a, int | float) and isinstance(b, int | float) and not isinstance(a, bool | str):
        return abs(angle_between(a, b, kind.period)) if kind.period else abs(b - a)
    return 0.0 if a == b else math.inf


def describe_move(slot_a: str | None, a: Pose, slot_b: str | None, b: Pose) -> str:
    """Return a move in words: `stowed in storage/a1`, `placed at (420, 420, 0°)`, `moved 12.5 mm, turned +5°`."""
    if slot_b:
        return f"moved to {slot_b}" if slot_a else f"stowed in {slot_b}"
    if slot_a:
        return f"placed at {b}"
    words = []
    if short(a.distance(b)) != "0":
        steps = [f"d{axis} {_signed(d)}" for axis, d in (("x", b.x - a.x), ("y", b.y - a.y)) if short(d) != "0"]
        words.append(f"moved {short(a.distance(b))} mm ({', '.join(steps)})")
    turned = angle_between(a.yaw, b.yaw)
    if short(turned) != "0":
        words.append(f"turned {_signed(turned)}°")
    return ", ".join(words) or _hardly(a, b)


def _hardly(a: Pose, b: Pose) -> str:
    """Return a move in words that rounding would hide."""
    away, turned = a.distance(b), angle_between(a.yaw, b.yaw)
    words = [f"moved {away:.2g} mm"] * bool(away) + [f"turned {turned:+.2g}°"] * bool(turned)
    return ", ".join(words) or f"yaw {a.yaw:g} → {b.yaw:g}°, the same direction"


def _signed(number: float) -> str:
    return ("+" if number > 0 else "") + short(number)


def describe_value(kind: Tunable, before: Any, after: Any) -> str:
    """Return a change of value in words: `90 → 1 deg`, `90 deg → 1° from the null of p1 and p2`."""
    unit = f" {kind.unit}" if kind.unit else ""
    if not is_reference(after):
        return f"{show_value(before, kind.unit)} → {show_value(after, kind.unit)}{unit}"
    own = unit if isinstance(before, int | float) and not isinstance(before, bool) else ""
    return f"{show_value(before, kind.unit)}{own} → {show_value(after, kind.unit)}"


def show_value(value: Any, unit: str = "deg") -> str:
    """Return a value as a person writes it in a manifest; one that light finds in words."""
    if value is None:
        return "unknown"
    if is_reference(value):
        return by_light(value, unit)
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.6g}" if isinstance(value, int | float) else str(value)
