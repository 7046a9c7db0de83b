"""Whether a plan still fits the bench: nothing that it stands on may have changed since."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from pico.diagnostics import Diagnostic, error
from pico.model.address import Renaming, renamed_keys, renaming_between
from pico.model.diff import Change, diff_observed, show_value, value_distance
from pico.model.lab import Lab
from pico.model.observation import GUARD, Observation, doubtful, slot_at
from pico.model.plan import Plan
from pico.model.pose import Pose, angle_between
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.state import LabState, place_of

MOST_PATHS = 6
"""So many differences of a lab are named."""


def staleness(setup: Setup, plan: Plan, seen: Observation) -> list[Diagnostic]:
    """Return what is not any more as `plan` assumes, saying what moved and by how much; empty for a plan that fits.

    The first that differs counts: the lab, the state that the plan starts from, a part that is to be picked: it must
    stand where the plan picks it, within its tolerance, slot or not. What the guard says of light that it ended comes
    before light that changed.
    """
    found = changes_since(setup, plan, seen) or list(_moved(setup, plan, seen))
    if not any(one.address.endswith((".emission", ".shutter")) for one in found):
        return found
    return [*(replace(one, severity="error") for one in seen.problems if one.code == GUARD), *found]


def changes_since(setup: Setup, plan: Plan, seen: Observation) -> list[Diagnostic]:
    """Return what changed if the lab or the bench is not as the plan assumes.

    A tunable counts as changed beyond its tolerance: |observed - base| > tolerance.
    """
    if plan.lab.digest != setup.digest():
        return [lab_edited()]
    return _changed(setup, plan.base_state, seen)


def lab_edited() -> Diagnostic:
    """Return the diagnostic that a plan is of another lab than the bench's."""
    return stale("", "the lab or its component types were edited since")


def stale(address: str, summary: str) -> Diagnostic:
    """Return the diagnostic that a plan is stale, and why."""
    hint = "give the command again: it plans anew; a saved plan goes with `pico apply --refresh FILE`"
    return error("stale", f"the plan is stale: {summary}", address=address, hint=hint)


def edited(then: Setup, now: Setup) -> list[str]:
    """Return what differs in two benches, as `differing` says it: `inventory.p3 added`, `p2 is now called p3`. A type
    that comes or goes with its parts is not told beside them."""
    names = renaming_between(then.lab, now.lab)
    both = then.catalog.keys() & now.catalog.keys()
    before, after = (_as_called(names, s.lab) for s in (then, now))
    differ = differing(*(
        as_json({"lab": lab, "types": {n: s.catalog[n] for n in both}}) for lab, s in ((before, then), (after, now))
    ))  # fmt: skip
    was = {new: old for old, new in names.items() if old in then.lab.inventory or old in now.lab.inventory}
    told = [f"{old} is now called {new}" if old in then.lab.inventory else f"{new} was called {old}"
            for new, old in sorted(was.items())]  # fmt: skip
    return [*told, *(path.removeprefix("lab.") for path in differ)]


def _as_called(names: Renaming, lab: Lab) -> Lab:
    """Return a lab by the present names of its parts, without what it says of former ones, which is told by itself."""
    if not names:
        return lab
    parts = renamed_keys(names, lab.inventory)
    return replace(lab, inventory={
        name: replace(part, formerly=None) if name in names.values() else part for name, part in parts.items()
    })  # fmt: skip


def differing(a: Any, b: Any, path: str = "") -> list[str]:
    """Return the paths at which JSON data differ: `table.beam_height 70 → 75`; the first few, and how many more."""
    found = list(_differing(a, b, path))
    more = len(found) - MOST_PATHS
    return found[:MOST_PATHS] + ([f"and {more} more"] if more > 0 else [])


def _differing(a: Any, b: Any, path: str) -> Iterator[str]:
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        for key in sorted(a.keys() | b.keys()):
            yield from _differing(a.get(key), b.get(key), f"{path}.{key}" if path else key)
    elif a != b:
        plain = all(isinstance(v, str | int | float | bool) for v in (a, b))
        what = f" {show_value(a)} → {show_value(b)}" if plain else " added" if a is None else ""
        yield path + (" removed" if b is None else what)


def _changed(setup: Setup, base: LabState, seen: Observation) -> list[Diagnostic]:
    found = []
    for name in sorted(base.components):
        part = seen.components.get(name)
        if name in setup.lab.inventory and (part is None or part.presence != "seen"):
            what = part.presence if part else "missing"
            found.append(stale(name, f"{name} is {what} now"))
    for change in diff_observed(setup, seen, base):
        if change.component in base.components and not change.tolerated and not _doubt(setup, change, base, seen):
            subject = change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"
            found.append(stale(subject, f"{subject} changed {_much(setup, change)}"))
    appeared = sorted(
        name for name in setup.lab.inventory
        if name not in base.components and name in seen.components and seen.components[name].presence == "seen"
    )  # fmt: skip
    return found + [stale(name, f"{name} was not seen then and is now") for name in appeared]


def _moved(setup: Setup, plan: Plan, seen: Observation) -> Iterator[Diagnostic]:
    checked = set()
    for op in plan.operations:
        if not op.kind.carries or op.component in checked:
            continue
        checked.add(op.component)
        part, start = seen.components.get(op.component), Pose(**op.arguments["from"]["pose"])
        if part is None or part.pose is None or op.component not in setup.lab.inventory:
            yield stale(op.component, f"{op.component} is not on the table")
            continue
        hand = seen.robots[op.robot].holding if op.robot and op.robot in seen.robots else None
        if bool(op.arguments["from"].get("held")) != (hand == op.component):
            yield stale(op.component, f"{op.robot} holds {hand or 'nothing'}")
            continue
        tolerance = setup.type_of(op.component).pose.tolerance
        away, turned = part.pose.distance(start), abs(angle_between(start.yaw, part.pose.yaw))
        if away > tolerance.position or turned > tolerance.yaw:
            yield stale(op.component, f"{op.component} was moved by {away:.3g} mm and {turned:.3g}° from {start}")


def _doubt(setup: Setup, change: Change, base: LabState, seen: Observation) -> bool:
    """Return whether a part that was seen too badly to say where in its slot it stands is in that slot still."""
    part = seen.components[change.component]
    if change.tunable != "pose" or part.pose is None or not doubtful(setup, change.component, part):
        return False
    slot = slot_at(setup, part.pose)
    return slot is not None and slot == slot_at(setup, place_of(setup, base, change.component)[1])


def _much(setup: Setup, change: Change) -> str:
    """Return by how much a tunable is off what the plan starts from, beside its tolerance."""
    kind, live, base = setup.type_of(change.component), change.before, change.after
    where = f"{_back(live)}, planned from {_back(base)}"
    if change.tunable != "pose":
        tunable = kind.tunables[change.tunable]
        if tunable.datatype == "float" and live is not None:
            apart = f"{value_distance(tunable, live, base):.4g} {tunable.unit}".rstrip()
            return f"by {apart}, tolerance {tunable.tolerance:g}: {where}"
        return f": {where}"
    if not isinstance(live, dict) or not isinstance(base, dict):
        return f": {where}"
    away = ((live["x"] - base["x"]) ** 2 + (live["y"] - base["y"]) ** 2) ** 0.5
    turned = abs(angle_between(live.get("yaw", 0.0), base.get("yaw", 0.0)))
    tolerance = f"{kind.pose.tolerance.position:g} mm, {kind.pose.tolerance.yaw:g}°"
    return f"by {away:.3g} mm, {turned:.3g}°, tolerance {tolerance}: {where}"


def _back(value: object) -> str:
    if isinstance(value, dict) and "x" in value:
        return f"({value['x']:.5g}, {value['y']:.5g}, {value.get('yaw', 0):.4g}°)"
    return show_value(value) if isinstance(value, str | float | bool | int) or value is None else str(value)
