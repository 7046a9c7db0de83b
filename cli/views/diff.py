"""The physical diff between two states."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.model.diff import Change
from pico.model.record import as_json

from . import budget
from .style import columns, count, listed, paint, place

if TYPE_CHECKING:
    from pico.diagnosis.claims import Budgeted
    from pico.history.diff.states import StateDiff


Budgets = tuple[str, "Budgeted", "Budgeted"]
"""A result by name, or as an expression; its error budgets in both states."""
_STEPS = re.compile(r" \(d[xy] [^()]*\)")


def text(
    found: StateDiff, *, a: str, b: str, next_step: str = "", stat: bool = False, budgets: Budgets | None = None
) -> str:
    """Return what differs from state `a` to state `b`, a line a tunable; with `stat` a line a component. `budgets`: of
    a result, its error budgets in both."""
    told = ["", *budget.change(*budgets)] if budgets else []
    if found.same:
        return f"{a} and {b} are the same."
    head = f"{paint('bold', a)} → {paint('bold', b)}"
    if not found.changes:
        return "\n".join([head, "No component differs.", *beside(found), *told])
    shown = _counts(found.changes) if stat else lines(found.changes)
    return "\n".join(
        [head, f"{tally(found.changes)}:", "", *shown, *beside(found), *told, *(["", next_step] if next_step else [])]
    )


def tally(changes: Sequence[Change]) -> str:
    """Return `3 tunables of 2 components differ`."""
    parts = len({c.component for c in changes})
    what = f"{count(len(changes), 'tunable')} of {count(parts, 'component')}"
    return f"{what} {'differs' if len(changes) == 1 else 'differ'}"


def beside(found: StateDiff) -> list[str]:
    """Return lines for what differs beside components: expectations, the bench itself, and text alone."""
    block = [f"  {paint('green' if sign == '+' else 'red', f'{sign} expects')} {that}" for sign, that in found.expected]
    if found.bench:
        both = " ".join(name for name in (found.a, found.b) if name)
        block.append(f"The bench itself differs: {listed(found.bench)} (`git diff {both} -- {found.bench[0]}`)")
    if found.text:
        block.append(f"And text that changes nothing physical: {listed(found.text)}")
    return ["", *block] if block else []


def _counts(changes: Sequence[Change]) -> list[str]:
    """Return a line a component: whether it moved, and how many of its tunables are set otherwise."""
    rows = []
    for name in dict.fromkeys(c.component for c in changes):
        mine = [c for c in changes if c.component == name]
        moved = [_STEPS.sub("", c.text) for c in mine if c.tunable == "pose"]
        values = [c.tunable for c in mine if c.tunable != "pose"]
        rows.append([name, ", ".join([*moved, *([f"{listed(values)} set"] if values else [])])])
    return columns(rows, indent="  ")


def lines(changes: Sequence[Change], indent: str = "  ") -> list[str]:
    """Return the changes as aligned lines: a symbol and the name, the motion, where from and to."""
    ordered = poses_first(changes)
    return columns([[f"{_symbol(c)} {name(c)}", said(c), paint("dim", _ends(c))] for c in ordered], indent=indent)


def poses_first(changes: Sequence[Change]) -> list[Change]:
    """Return the changes with what stands elsewhere before what is set otherwise."""
    return sorted(changes, key=lambda c: c.tunable != "pose")


def said(change: Change) -> str:
    """Return a change in words; a value that one of the two states does not give is set, or left open."""
    if change.tunable != "pose" and change.before is None:
        return f"set to {change.text.removeprefix('unknown → ')}"
    if change.tunable != "pose" and change.after is None and "→" in change.text:
        return f"not given any more (was {place(change.before)})"
    return change.text


def name(change: Change) -> str:
    """Return `p2` for a pose, `p1.angle` for another tunable."""
    return change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"


def brief(changes: Sequence[Change], limit: int = 4) -> str:
    """Return the changes in one line: `p2 turned +30°, p1.angle 90 → 1 deg`."""
    words = [f"{name(c)} {said(c)}" for c in poses_first(changes)[:limit]]
    more = len(changes) - limit
    return ", ".join(words) + (f" and {more} more" if more > 0 else "")


def _symbol(change: Change) -> str:
    if change.tunable != "pose":
        return paint("yellow", "~")
    if isinstance(change.after, str):
        return paint("yellow", "-")
    return paint("green", "+") if isinstance(change.before, str) and change.after is not None else paint("yellow", "~")


def _ends(change: Change) -> str:
    if change.requested:
        return "a request"
    if change.tunable != "pose" or change.before is None or change.after is None:
        return ""
    if isinstance(change.before, str) and not isinstance(change.after, str):
        return f"from {change.before}"
    return f"from {place(change.before)}" + ("" if isinstance(change.after, str) else f" to {place(change.after)}")


def data(found: StateDiff, *, a: str, b: str, budgets: Budgets | None = None, **_: Any) -> dict[str, Any]:
    """Return schema `pico.diff/v1`: `from`, `to`, `changes` (component, tunable, before, after, text), `expected`,
    `bench` and `text` (files); `budgets`: of a result before and after, as in `pico.budget/v1`."""
    told = as_json(found)
    beside = {"budgets": [budget.one_data(one) for one in budgets[1:]]} if budgets else {}
    return (
        {"schema": "pico.diff/v1", "from": a, "to": b}
        | {k: told[k] for k in ("changes", "expected", "bench", "text")}
        | beside
    )
