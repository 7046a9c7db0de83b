"""What `pico capture` wrote."""

from __future__ import annotations

from typing import Any

from pico.model.record import as_json
from pico.model.trace.report import Captured

from .by_light import stays
from .diff import lines
from .style import count, listed

_NOTHING = "Nothing to capture: the manifest already says what stands on the bench."


def text(captured: Captured) -> str:
    """Return which tunables changed in which files."""
    kept = stays(captured.by_light or ())
    if not captured.changes:
        return f"Nothing to capture: {kept[0].lower()}{kept[1:]}" if kept else _NOTHING
    where = listed(captured.files)
    what = f"{count(len(captured.changes), 'tunable')} into {where}:"
    if not captured.written:
        block = [f"Would write {what}", "", *lines(captured.changes), "", captured.patch.rstrip("\n")]
        return "\n".join([*block, "", "Nothing was written; `pico capture` without --dry-run does it."])
    last = '`git diff` shows the lines; `pico commit -m "why"` keeps it.'
    return "\n".join([f"Captured {what}", "", *lines(captured.changes), "", last, *([kept] if kept else [])])


def data(captured: Captured) -> dict[str, Any]:
    """Return schema `pico.capture/v1`: `files`, `changes`, `written`, `patch` and `by_light`."""
    return {"schema": "pico.capture/v1", **as_json(captured)}
