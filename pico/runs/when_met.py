"""The bench as it was when a goal was met last, and what was measured then, as the journal knows it."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from pico.model.operation import touched_by
from pico.model.pose import Pose
from pico.model.primitive import primitive
from pico.model.quantities import Value
from pico.model.state import ComponentState, LabState
from pico.planning.aligned_values import GoalMet
from pico.runs.journal import JournalRecord
from pico.runs.memory import Memory

MOST = 200
"""Runs that are looked back."""


def when_met(memory: Memory | None, lab: str, goal: str) -> LabState | None:
    """Return where parts stood and what their tunables read at the end of the last run in which a goal was met; None
    where none met it. Raises PicoError where the journal can't be read."""
    for run in reversed(memory.runs()[-MOST:]) if memory else ():
        after = memory.about(run.run)[1] if memory and _met(memory, run.run, goal) else None
        if after is not None:
            return LabState(lab=lab, components={n: _state(part) for n, part in after["components"].items()})
    return None


def measured_when_met(memory: Memory | None, name: str, goal: Mapping[str, Any]) -> Mapping[str, float] | None:
    """Return what was measured when a goal (as JSON, by its name) was met last, and was the same; None where it never
    was. Raises PicoError where the journal can't be read."""
    if memory is None:
        return None
    for run in reversed(memory.runs()[-MOST:]):
        for one in _met(memory, run.run, name)[::-1]:
            if all(one.what.get(key) == goal.get(key) for key in _MEASURED):
                return one.last
    return None


def met_before(memory: Memory, goals: Mapping[str, Mapping[str, Any]]) -> Iterator[GoalMet]:
    """Yield when goals (as JSON, by name) were met on a bench and were the same, the last time first, with where its
    parts stood then. Runs after which nobody looked are left out. Raises PicoError where the journal can't be read."""
    for one, what in met_at_all(memory):
        if one.goal in goals and all(what.get(key) == goals[one.goal].get(key) for key in _MEASURED):
            yield one


def met_at_all(memory: Memory) -> Iterator[tuple[GoalMet, Mapping[str, Any]]]:
    """Yield each time that a goal was met on a bench, of the lab or ready-made, the last time first, with what was
    sought (a goal as JSON). Runs after which nobody looked are left out. Raises PicoError if the journal can't be
    read."""
    for run in reversed(memory.runs()[-MOST:]):
        own = memory.records(run=run.run)
        begun = {r.key: r.data["arguments"] for r in own if r.kind == "intent"}
        ends = [r for r in own if r.kind == "done" and (r.data.get("data") or {}).get("met")]
        after = memory.about(run.run)[1] if ends else None
        for end in reversed(ends) if after else ():
            name, what = str(begun.get(end.key, {}).get("goal")), begun.get(end.key, {}).get("what", {})
            poses = _poses(after or {}, [r for r in own if r.kind == "intent" and r.seq > end.seq])
            yield GoalMet(name, end.at, end.data["data"].get("last") or {}, poses), what


def _poses(after: Mapping[str, Any], since: Sequence[JournalRecord]) -> dict[str, Pose]:
    """Return where parts stood before operations that were begun in a run, from how they stood after it."""
    found = {n: Pose(**part["pose"]) for n, part in after["components"].items() if part.get("pose")}
    for record in reversed(since):
        start = (record.data.get("arguments") or {}).get("from")
        if isinstance(start, Mapping) and "pose" in start and record.component in found:
            found[record.component] = Pose(**start["pose"])
    return found


def not_set_by_plans(memory: Memory, addresses: Collection[str]) -> set[str]:
    """Return the tunables, among some by address, that something else than a plan to a state set last: a search, a
    person, a script, an undo. Raises PicoError where the journal can't be read."""
    left, found = set(addresses), set[str]()
    for run in reversed(memory.runs()[-MOST:]):
        if not left:
            break
        own = memory.records(run=run.run)
        begun = {r.key for r in own if r.kind == "started"}
        target = json.loads(memory.document(run.run) or "{}").get("target", {})
        deliberate = target.get("cause") in _BACK or (target.get("title") and not target.get("cause"))
        for record in reversed([r for r in own if r.kind == "intent" and r.key in begun]):
            if not primitive(str(record.data["primitive"])).mutating:
                continue
            touched = {f"{c}.{t}" for c, t in touched_by(record.component, record.data["arguments"])} & left
            why = (record.data.get("reason") or {}).get("kind")
            found |= touched if deliberate or why in ("asked", "align") else set()
            left -= touched
    return found


def ever_stood(memory: Memory, address: str, fits: Callable[[Value], bool]) -> bool:
    """Return whether a tunable had a value that `fits` before or after one of the last runs of a bench. Raises
    PicoError where the journal can't be read."""
    component, _, tunable = address.partition(".")
    for run in reversed(memory.runs()[-MOST:]):
        after = (memory.about(run.run)[1] or {}).get("components", {}).get(component, {}).get("values", {})
        before = json.loads(memory.document(run.run) or "{}").get("base", {}).get("state", {})
        values = (after.get(tunable, {}).get("value"), before.get("components", {}).get(component, {}).get(tunable))
        if any(value is not None and fits(value) for value in values):
            return True
    return False


_BACK = ("undo", "redo")
_MEASURED = ("reach", "minimize", "maximize", "during", "looks")
"""What of a goal says what is measured of it."""


class _Met(NamedTuple):
    """A goal as it was when it was met (JSON), and what was measured then."""

    what: Mapping[str, Any]
    last: Mapping[str, float]


def _met(memory: Memory, run: str, goal: str) -> list[_Met]:
    """Return each time that a goal was met in a run."""
    own = memory.records(run=run)
    begun = {r.key: r.data["arguments"] for r in own if r.kind == "intent"}
    ended = [(begun[r.key], r.data.get("data") or {}) for r in own if r.kind == "done" and r.key in begun]
    return [_Met(a.get("what", {}), found.get("last") or {}) for a, found in ended
            if a.get("goal") == goal and found.get("met")]  # fmt: skip


def _state(part: Mapping[str, Any]) -> ComponentState:
    """Return a component as it was observed, from its JSON."""
    pose = part.get("pose")
    values = {name: one["value"] for name, one in part.get("values", {}).items() if one.get("value") is not None}
    return ComponentState(pose=Pose(**pose) if pose else None, values=values)
