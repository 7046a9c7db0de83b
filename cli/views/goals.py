"""The goals that there are, and how they stand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pico.model.lab import Goal
from pico.model.record import as_json

from .style import ago, columns, paint

if TYPE_CHECKING:
    from pico.bench.aligned import Alignment

_STYLES = {"aligned": "green", "stale": "yellow", "lost": "red"}


def text(goals: Mapping[str, Goal], standing: Sequence[Alignment], ready: Mapping[str, str]) -> str:
    """Return the goals of the lab in the order along the beam, with how they stand, and those that are ready made."""
    rows = [[paint("dim", cell) for cell in ("goal", "stands", "what it is", "by")]]
    for one in standing:
        goal = goals[one.goal]
        said = paint(_STYLES[one.status], one.status) if one.status in _STYLES else one.status
        when = f", {ago(one.at)}" if one.at else ""
        aim = ", ".join(goal.reach or ()) or goal.expressions[0]
        rows.append([one.goal, f"{said}{when}", goal.description or f"{goal.aim} {aim}", ", ".join(goal.tunables)])
        rows += [["", f"  {one.why}", "", ""]] if one.why else []
    own = columns(rows) if goals else ["The lab has no goals of its own: `goals:` in lab.yaml."]
    made = [[f"pico optimize {name}", what] for name, what in ready.items()]
    return "\n".join([*own, "", "Ready made:", *(f"  {row}" for row in columns(made))])


def data(goals: Mapping[str, Goal], standing: Sequence[Alignment], ready: Mapping[str, str]) -> dict[str, Any]:
    """Return schema `pico.goals/v1`: `goals` by name, how each stands (`alignments`: `status`, `why`, `at`, `last`),
    and `ready` made ones with what they are told."""
    return {
        "schema": "pico.goals/v1", "goals": as_json(dict(goals)), "alignments": [as_json(one) for one in standing],
        "ready": dict(ready),
    }  # fmt: skip
