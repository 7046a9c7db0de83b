"""Commits with what each changed on the table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pico.history.folder import Entry
from pico.history.graph import Row, lanes
from pico.model.record import as_json

from .diff import brief, lines
from .style import WIDTH, count, pad, paint, width, wrap


def text(entries: Iterable[Entry], *, graph: bool, oneline: bool, head: str | None = None) -> str:
    """Return the commits, newest first, with a rail of the branches where `graph`; `head` is the one checked out."""
    shown = list(entries)
    if not shown:
        return "No commit has touched this lab yet."
    rows = lanes([e.commit for e in shown]) if graph else [Row("", e.commit) for e in shown]
    by_id = {e.commit.id: e for e in shown}
    found: list[str] = []
    render = _short(shown, head) if oneline or graph else _long
    for i, row in enumerate(rows):
        rail = f"{row.rail} " if graph else ""
        if row.commit is None:
            found.append(rail.rstrip())
            continue
        first, *rest = render(by_id[row.commit.id], WIDTH - len(rail))
        found.append(rail + first)
        below = _below(rows, i) if graph else ""
        found += [f"{below}{line}".rstrip() for line in rest]
    return "\n".join(found).rstrip()


def _below(rows: list[Row], i: int) -> str:
    """Return the rail under a commit: its own line of history goes on where it has a parent on the rail."""
    rail = rows[i].rail
    ends = i + 1 >= len(rows) or rows[i + 1].rail[rail.index("*") : rail.index("*") + 1] in ("", " ")
    return rail.replace("*", " " if ends else "|") + " "


def _short(shown: list[Entry], checked_out: str | None) -> Any:
    """Return a function from a commit to one line: name, message, motions; two where they do not fit."""
    names = min(max(width(_name(e, checked_out)) for e in shown), 24)
    room = min(max(width(e.commit.summary) for e in shown), 44)

    def render(entry: Entry, columns: int) -> list[str]:
        head = f"{pad(paint('yellow', _name(entry, checked_out)), names)}  {pad(entry.commit.summary, room)}"
        what = _what(entry)
        if width(head) + 2 + width(what) <= columns:
            return [f"{head}  {paint('cyan', what)}".rstrip()]
        indent = " " * (names + 2)
        return [head.rstrip(), *(paint("cyan", line) for line in wrap(what, indent, columns))]

    return render


def _name(entry: Entry, checked_out: str | None) -> str:
    name = ", ".join(list(dict.fromkeys(entry.commit.refs))[:2]) or entry.commit.short
    return f"{name} (HEAD)" if entry.commit.id == checked_out else name


def _what(entry: Entry) -> str:
    if entry.unreadable:
        return f"can't be read: {entry.unreadable}"
    if not entry.changes:
        return "nothing on the table"
    if not entry.commit.parents:
        moved = sum(c.tunable == "pose" for c in entry.changes)
        values = len(entry.changes) - moved
        parts = [count(moved, "component") + " away from home"] * bool(moved) + [
            count(values, "tunable") + " set"
        ] * bool(values)
        return f"the first state: {', '.join(parts)}"
    return brief(entry.changes)


def _long(entry: Entry, _: int) -> list[str]:
    c = entry.commit
    refs = f" ({', '.join(c.refs)})" if c.refs else ""
    head = [paint("yellow", f"commit {c.short}{refs}"), f"{c.author}, {c.time:%Y-%m-%d %H:%M}"]
    what = [f"  {_what(entry)}"] if entry.unreadable or not entry.changes else lines(entry.changes)
    return [*head, "", *wrap(c.message, "    "), "", *what, ""]


def data(entries: Iterable[Entry], *, graph: bool, oneline: bool, head: str | None = None) -> dict[str, Any]:
    """Return schema `pico.log/v1`: `head`, and `commits`: id, parents, refs, author, time, message, changes, rail."""
    shown = list(entries)
    rails = {r.commit.id: r.rail for r in lanes([e.commit for e in shown]) if r.commit} if graph else {}
    commits = [entry_data(e) | ({"rail": rails[e.commit.id]} if graph else {}) for e in shown]
    return {"schema": "pico.log/v1", "head": head, "commits": commits}


def entry_data(entry: Entry) -> dict[str, Any]:
    """Return one commit with its physical diff as JSON data."""
    c = entry.commit
    return {
        "id": c.id, "parents": list(c.parents), "refs": list(c.refs), "author": c.author, "time": c.time.isoformat(),
        "message": c.message, "changes": as_json(entry.changes),
    } | ({"unreadable": entry.unreadable} if entry.unreadable else {})  # fmt: skip
