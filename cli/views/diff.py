"""The physical diff between two states."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.model.diff import Change
from pico.model.record import as_json

from .style import columns, count, paint, place


def text(changes: Sequence[Change], *, a: str, b: str, next_step: str = "") -> str:
    """Return what differs from state `a` to state `b`, a line a tunable."""
    if not changes:
        return f"{a} and {b} are the same."
    parts = len({c.component for c in changes})
    head = f"{paint('bold', a)} → {paint('bold', b)}: {count(len(changes), 'tunable')} of {count(parts, 'component')}"
    return "\n".join([f"{head} {'differs' if len(changes) == 1 else 'differ'}", "", *lines(changes)]) + (
        f"\n\n{next_step}" if next_step else ""
    )


def lines(changes: Sequence[Change], indent: str = "  ") -> list[str]:
    """Return the changes as aligned lines: a symbol and the name, the motion, where from and to."""
    return columns([[f"{_symbol(c)} {name(c)}", c.text, paint("dim", _ends(c))] for c in changes], indent=indent)


def name(change: Change) -> str:
    """Return `p2` for a pose, `p1.angle` for another tunable."""
    return change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"


def brief(changes: Sequence[Change], limit: int = 4) -> str:
    """Return the changes in one line: `p2 turned +30°, p1.angle 90 → 1 deg`."""
    said = [f"{name(c)} {c.text}" for c in changes[:limit]]
    more = len(changes) - limit
    return ", ".join(said) + (f" and {more} more" if more > 0 else "")


def _symbol(change: Change) -> str:
    if change.tunable != "pose":
        return paint("yellow", "~")
    if isinstance(change.after, str):
        return paint("yellow", "-")
    return paint("green", "+") if isinstance(change.before, str) else paint("yellow", "~")


def _ends(change: Change) -> str:
    if change.tunable != "pose" or change.before is None:
        return ""
    if isinstance(change.before, str) and not isinstance(change.after, str):
        return f"from {change.before}"
    return f"from {place(change.before)}" + ("" if isinstance(change.after, str) else f" to {place(change.after)}")


def data(changes: Sequence[Change], *, a: str, b: str, **_: Any) -> dict[str, Any]:
    """Return schema `pico.diff/v1`: `from`, `to`, `changes` (component, tunable, before, after, text)."""
    return {"schema": "pico.diff/v1", "from": a, "to": b, "changes": as_json(changes)}
