"""The goals that there are, and how they stand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.model.goal import Goal
from pico.model.record import as_json

from .style import ago, columns, paint, wrap

if TYPE_CHECKING:
    from pico.planning.alignment import Alignment

_STYLES = {"aligned": "green", "stale": "yellow", "lost": "red"}


def text(goals: Mapping[str, Goal], standing: Sequence[Alignment], ready: Mapping[str, str]) -> str:
    """Return the goals of the lab in the order along the beam, with how they stand, and those that are ready made."""
    rows = [[paint("dim", cell) for cell in ("goal", "stands", "by")]]
    below: list[list[str]] = [[]]
    for one in standing:
        goal = goals.get(one.goal)
        said = paint(_STYLES[one.status], one.status) if one.status in _STYLES else one.status
        when = f", {ago(one.at)}" if one.at else ""
        rows.append([one.goal, f"{said}{when}", ", ".join(goal.tunables) if goal else ""])
        why = wrap(one.why, "  ") if one.why else []
        below.append([*why, *(paint("dim", row) for row in wrap(_aim(goal), "  "))])
    own = [line for row, more in zip(columns(rows), below, strict=True) for line in (row, *more)]
    left = max(map(len, ready), default=0) + len("  pico optimize   ")
    made = []
    for name, what in ready.items():
        first, *rest = wrap(what, " " * left)
        made += [f"  pico optimize {name}".ljust(left) + first[left:], *rest]
    none = ["The lab has no goals of its own: `goals:` in lab.yaml."]
    return "\n".join([*(own if standing else none), "", "Ready made:", *made])


def _aim(goal: Goal | None) -> str:
    """Return what a goal is, in words; nothing of one that can't be sought."""
    if goal is None:
        return ""
    return goal.description or f"{goal.aim} {', '.join(goal.reach or ()) or goal.expressions[0]}"


def data(goals: Mapping[str, Goal], standing: Sequence[Alignment], ready: Mapping[str, str]) -> dict[str, Any]:
    """Return schema `pico.goals/v1`: `goals` by name, how each stands (`alignments`: `status`, `why`, `at`, `last`),
    and `ready` made ones with what they are told."""
    return {
        "schema": "pico.goals/v1", "goals": as_json(dict(goals)), "alignments": [as_json(one) for one in standing],
        "ready": dict(ready),
    }  # fmt: skip
