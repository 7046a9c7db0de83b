"""The bench as it was when a goal was met last, and what was measured then, as the journal knows it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from pico.model.pose import Pose
from pico.model.state import ComponentState, LabState
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
