"""Who changed each tunable last, and how."""

from __future__ import annotations

from typing import Any

from pico.base import clock
from pico.history.blame.blamed import Blamed, BlamedLeaf, LeafChange
from pico.history.blame.how import How
from pico.history.lab.notes import Note
from pico.model.record import as_json

from .style import columns, count, paint, shorten, valued, wide, width

_HEAD = ("tunable", "value", "commit", "when", "how", "who", "why")


def text(blamed: Blamed, *, asked: bool) -> str:
    """Return a line a tunable, by component; with histories, a line a change below each."""
    if not blamed.leaves:
        return "No state has been committed yet." if blamed.commit is None else f"The state at {blamed.name} is empty."
    changed = [leaf.history for leaf in blamed.leaves if leaf.history is not None]
    lines = _histories(blamed) if changed else _table(blamed.leaves)
    noted = [f"{paint('bold', part)}: {n.text}{_by(n)}" for part, found in blamed.notes.items() for n in found]
    said = [noted, (_runs(blamed) if asked else [_tally(blamed)]), _shallow(blamed)]
    return "\n".join([*lines, *(line for block in said if block for line in ("", *block))])


def _table(leaves: tuple[BlamedLeaf, ...]) -> list[str]:
    rows = [[_address(leaf), _value(leaf), *_turn(leaf.last, "%Y-%m-%d")] for leaf in leaves]
    return _fitted([[paint("dim", cell) for cell in _HEAD], *rows])


def _histories(blamed: Blamed) -> list[str]:
    lines: list[str] = []
    for leaf in blamed.leaves:
        rows = [[turn.text, *_turn(turn, "%Y-%m-%d %H:%M")] for turn in leaf.history or ()]
        lines += ["", f"{paint('bold', _address(leaf))} {_value(leaf)}", *_fitted(rows, "  ")]
    return lines[1:]


def _fitted(rows: list[list[str]], indent: str = "") -> list[str]:
    """Return aligned lines; the last cell, what the commit says of itself, takes the room that is left."""
    taken = len(indent) + sum(2 + max(width(row[i]) for row in rows) for i in range(len(rows[0]) - 1))
    return columns(rows, indent=indent, last=max(wide() - taken, 16))


def _turn(turn: LeafChange, form: str) -> list[str]:
    if turn.commit is None:
        return [paint("cyan", "not committed"), "", "", "", ""]
    short = turn.commit[:7]
    name = short if turn.name in ("", short) else f"{short} {shorten(turn.name, 14)}"
    earlier = " or earlier" if turn.earlier else ""
    when = format(clock.parse(turn.time), form)
    return [paint("yellow", name) + earlier, when, said(turn.how), shorten(turn.author, 16), turn.summary]


def said(how: How) -> str:
    """Return how a leaf got its value, in few words: `apply a1b2c3`, `by hand`, `edited`."""
    if how.kind == "run":
        step = f" step {how.step}" if how.step else ""
        what = f"{how.cause} {how.recipe}{step}" if how.recipe else how.cause or "run"
        return f"{what} {(how.run or '').rpartition('Z-')[2]}"
    return {"hand": "by hand", "commit": "-", "edit": "", "planned": "edited, planned"}.get(how.kind, how.kind)


def _address(leaf: BlamedLeaf) -> str:
    return f"{leaf.component}.{leaf.tunable}"


def _value(leaf: BlamedLeaf) -> str:
    if leaf.value is None:
        return paint("dim", "gone")
    return valued(leaf.value, leaf.unit)


def _tally(blamed: Blamed) -> str:
    parts = len({leaf.component for leaf in blamed.leaves})
    edited = ", with edits that are not committed" if blamed.edited else ""
    what = f"{count(len(blamed.leaves), 'tunable')} of {count(parts, 'component')}"
    return f"{what} at {blamed.name}{edited}. `pico blame COMPONENT --history` shows every change of one."


def _by(note: Note) -> str:
    return paint("dim", f"  ({note.author}, {note.day})") if note.author else ""


def _runs(blamed: Blamed) -> list[str]:
    """Return how to see the newest of the runs that are named."""
    runs = {t.how.run for leaf in blamed.leaves for t in (leaf.last, *(leaf.history or ())) if t.how.run}
    return [f"`pico runs show {max(runs)}` shows what that run did."] if runs else []


def _shallow(blamed: Blamed) -> list[str]:
    if not any(t.earlier for leaf in blamed.leaves for t in (leaf.last, *(leaf.history or ()))):
        return []
    return ["or earlier: this clone is shallow, older commits are not here; `git fetch --unshallow` brings them."]


def data(blamed: Blamed, **_: Any) -> dict[str, Any]:
    """Return schema `pico.blame/v1`: `commit`, `name`, `edited`, `notes`, `diagnostics`, `leaves`: component, tunable,
    value, unit, `last` and `history`: commit, name, author, time, summary, how, before, after, text, earlier."""
    return {"schema": "pico.blame/v1", **as_json(blamed)}
