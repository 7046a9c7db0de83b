"""The goals that there are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pico.model.lab import Goal
from pico.model.record import as_json

from .style import columns, paint


def text(goals: Mapping[str, Goal], ready: Mapping[str, str]) -> str:
    """Return the goals of the lab, and those that are ready made."""
    rows = [[paint("dim", cell) for cell in ("goal", "what it is", "by")]]
    for name, goal in sorted(goals.items()):
        aim = ", ".join(goal.reach or ()) or goal.texts[0]
        rows.append([name, goal.description or f"{goal.aim} {aim}", ", ".join(goal.tunables)])
    own = columns(rows) if goals else ["The lab has no goals of its own: `goals:` in lab.yaml."]
    made = [[f"pico optimize {name}", what] for name, what in ready.items()]
    return "\n".join([*own, "", "Ready made:", *(f"  {row}" for row in columns(made))])


def data(goals: Mapping[str, Goal], ready: Mapping[str, str]) -> dict[str, Any]:
    """Return schema `pico.goals/v1`: `goals` by name, `ready` made ones with what they are told."""
    return {"schema": "pico.goals/v1", "goals": as_json(dict(goals)), "ready": dict(ready)}
