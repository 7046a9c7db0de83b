"""What a commit says where nobody says why: the physical diff, the most of it in one line, and all of it below."""

from __future__ import annotations

import re
from collections.abc import Sequence

from pico.model.diff import Change

WIDTH = 72
"""Columns of the first line, as git's own tools show them."""
BELOW = 12
"""Lines below it at most: a message is read on a screen, and the diff says the rest."""
_STEPS = re.compile(r" \(d[xy] [^()]*\)")


def default_message(changes: Sequence[Change], files: Sequence[str] = ()) -> str:
    """Return a message for a commit with these physical changes to these files, by paths relative to the lab.

    The first line is of at most 72 characters, plain ones: they pass through every mail and every terminal. Nothing
    follows it where it says everything.
    """
    if not changes:
        return _nothing_moved(files)
    ordered = sorted(changes, key=lambda c: c.tunable != "pose")
    body = "\n".join(_most([_plain(f"{_address(c)} {_said(c)}{_ends(c)}") for c in ordered]))
    subject = _subject(ordered)
    return subject if subject == body else f"{subject}\n\n{body}"


def _subject(changes: Sequence[Change]) -> str:
    """Return as many changes as fit into a line, and how many more there are."""
    items = [_plain(f"{_address(c)} {_STEPS.sub('', _said(c))}") for c in changes]
    for shown in range(len(items), 0, -1):
        more = len(items) - shown
        line = "; ".join(items[:shown]) + (f"; and {more} more" if more else "")
        if len(line) <= WIDTH:
            return line
    parts = len({c.component for c in changes})
    return f"{_count(len(changes), 'tunable')} of {_count(parts, 'component')} changed"


def _nothing_moved(files: Sequence[str]) -> str:
    head = "Nothing on the table changed"
    if not files:
        return head
    kinds = "runs" if all(f.startswith("runs/") for f in files) else ""
    kinds = "notes" if all(f.startswith("notes/") for f in files) else kinds
    shown = [f for f in files if not f.startswith("runs/")] or list(files)
    named = ", ".join(shown[:2]) + (f" and {len(shown) - 2} more" if len(shown) > 2 else "")
    subject = f"{head}: {kinds or f'comments or layout of {named}'}"
    subject = subject if len(subject) <= WIDTH else f"{head}: {_count(len(shown), 'file')}"
    return subject + "\n\n" + "\n".join(_most(files))


def _most(lines: Sequence[str]) -> Sequence[str]:
    return lines if len(lines) <= BELOW else [*lines[: BELOW - 1], f"and {len(lines) - BELOW + 1} more"]


def _address(change: Change) -> str:
    return change.component if change.tunable == "pose" else f"{change.component}.{change.tunable}"


def _said(change: Change) -> str:
    """Return a change in words; a value that one of the two states does not give is set, or left open."""
    if change.tunable != "pose" and change.before is None:
        return f"set to {change.text.removeprefix('unknown → ')}"
    if change.tunable != "pose" and change.after is None:
        return "not given any more"
    return change.text


def _ends(change: Change) -> str:
    """Return where a move began and ended, as far as its words don't say so."""
    if change.tunable != "pose" or change.before is None:
        return ""
    before, after = _place(change.before), _place(change.after)
    between_poses = isinstance(change.before, dict) and isinstance(change.after, dict)
    return f", from {before} to {after}" if between_poses else f", from {before}"


def _place(place: object) -> str:
    if isinstance(place, dict):
        return f"({place['x']:g}, {place['y']:g}, {place['yaw']:g}°)"
    return str(place)


def _plain(text: str) -> str:
    return text.replace("°", " deg").replace("→", "->").replace("±", "+-").replace("µ", "u")


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
