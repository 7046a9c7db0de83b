"""The states between which a run led, and what it changed."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from pico.model.diff import (
    Change,
    describe_move,
    deviation,
    diff_states,
    place_json,
    slot_left,
    value_deviation,
)
from pico.model.observation import Observation, ObservedComponent, live_state, observed_from_json, slot_at
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, place_of
from pico.runs.journal import JournalRecord


def state_seen(setup: Setup, components: Mapping[str, Any]) -> LabState:
    """Return the state of components as they were observed; `components`: JSON of `ObservedComponent` by name."""
    read = {name: observed_from_json(data) for name, data in components.items()}
    return _live(setup, {name: part for name, part in read.items() if part is not None})


def state_left(setup: Setup, before: LabState, records: Iterable[JournalRecord]) -> LabState:
    """Return the state that operations led to from `before`, as each of them saw its own component."""
    parts = dict(before.components)
    for r in records:
        after = observed_from_json(r.data.get("after")) if r.kind not in ("intent", "started") else None
        if after is not None:
            parts.pop(r.component, None)
            parts |= _live(setup, {r.component: after}).components
    return replace(before, components=parts)


def states_along(setup: Setup, before: LabState, records: Iterable[JournalRecord]) -> dict[int, tuple[str, str]]:
    """Return for each record that ended an operation the digests of the states from which that led and to which, as
    each operation saw its own component; what ran side by side counts when it ended."""
    now, known, begun, found = before, digest_of(setup, before), dict[str, str](), dict[int, tuple[str, str]]()
    for r in records:
        if r.kind == "started":
            begun[r.key] = known
        elif r.kind != "intent":
            left = state_left(setup, now, [r])
            if left.components != now.components:
                now, known = left, digest_of(setup, left)
            found[r.seq] = begun.get(r.key, known), known
    return found


def digest_of(setup: Setup, state: LabState) -> str:
    """Return the digest of an observed state in the form of a manifest whose parts in slots are named by these."""
    parts = {}
    for name, part in state.components.items():
        slot = slot_at(setup, part.pose) if part.pose and setup.movable(name) else None
        parts[name] = replace(part, slot=slot, pose=None) if slot else part
    return replace(state, components=parts).digest()


def touched(records: Iterable[JournalRecord]) -> frozenset[str]:
    """Return the components on which something began."""
    return frozenset(r.component for r in records if r.kind == "started")


def changes(setup: Setup, before: LabState, after: LabState, among: Collection[str]) -> tuple[Change, ...]:
    """Return what differs between two observed states, `tolerated` where by no more than the tolerance.

    Only components `among` those count, as far as the inventory has them. One that nobody saw in one of the states has
    no place there.
    """
    names = [n for n in sorted(among) if n in setup.lab.inventory]
    both = [n for n in names if n in before.components and n in after.components]
    found = [_judged(setup, c) for c in diff_states(setup, _only(before, both), _only(after, both))]
    found += [c for n in names if n not in both for c in _unseen(setup, n, before, after)]
    return tuple(sorted(found, key=lambda c: (c.component, c.tunable)))


def _live(setup: Setup, parts: Mapping[str, ObservedComponent]) -> LabState:
    known = {name: part for name, part in parts.items() if name in setup.lab.inventory}
    return live_state(setup, Observation(backend="", components=known))


def _only(state: LabState, names: Sequence[str]) -> LabState:
    return replace(state, components={n: state.components[n] for n in names})


def _unseen(setup: Setup, name: str, before: LabState, after: LabState) -> list[Change]:
    one, other = before.components.get(name), after.components.get(name)
    if one is None and other is None:
        return []

    def place(state: LabState, part: ComponentState | None) -> Any:
        return place_json(*place_of(setup, state, name)) if part else None

    text = "not seen afterwards" if other is None else "not seen before"
    return [Change(component=name, tunable="pose", before=place(before, one), after=place(after, other), text=text)]


def _judged(setup: Setup, change: Change) -> Change:
    kind = setup.type_of(change.component)
    if change.tunable != "pose":
        own = kind.tunables.get(change.tunable)
        if own is None or change.before is None or change.after is None:
            return change
        return replace(change, tolerated=value_deviation(own, change.before, change.after) != "off")
    if not (isinstance(change.before, Mapping) and isinstance(change.after, Mapping)):
        return change  # of an older journal, which kept the names of slots
    a, b = Pose(**change.before), Pose(**change.after)
    slots = slot_left(setup, change.component, a, b), slot_left(setup, change.component, b, a)
    return replace(
        change, before=place_json(slots[0], a), after=place_json(slots[1], b),
        text=describe_move(slots[0], a, slots[1], b),
        tolerated=deviation(setup, change.component, a, None, b) != "off",
    )  # fmt: skip
