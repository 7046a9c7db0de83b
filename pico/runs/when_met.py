"""The bench as it was when a goal was met last, as the journal knows it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

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


def _met(memory: Memory, run: str, goal: str) -> bool:
    own = memory.records(run=run)
    keys = {r.key for r in own if r.kind == "intent" and r.data.get("arguments", {}).get("goal") == goal}
    return any(r.key in keys and r.kind == "done" and (r.data.get("data") or {}).get("met") for r in own)


def _state(part: Mapping[str, Any]) -> ComponentState:
    """Return a component as it was observed, from its JSON."""
    pose = part.get("pose")
    values = {name: one["value"] for name, one in part.get("values", {}).items() if one.get("value") is not None}
    return ComponentState(pose=Pose(**pose) if pose else None, values=values)
