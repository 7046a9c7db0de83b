"""What `pico capture` wrote."""

from __future__ import annotations

from typing import Any

from pico.model.record import as_json
from pico.model.report import Captured

from .diff import lines
from .style import count, listed


def text(captured: Captured) -> str:
    """Return which tunables changed in which files."""
    if not captured.changes:
        return "Nothing to capture: the manifest already says what stands on the bench."
    where = listed(captured.files)
    what = f"{count(len(captured.changes), 'tunable')} into {where}:"
    if not captured.written:
        block = [f"Would write {what}", "", *lines(captured.changes), "", captured.patch.rstrip("\n")]
        return "\n".join([*block, "", "Nothing was written; `pico capture` without --dry-run does it."])
    last = '`git diff` shows the lines; `pico commit -m "why"` keeps it.'
    return "\n".join([f"Captured {what}", "", *lines(captured.changes), "", last])


def data(captured: Captured) -> dict[str, Any]:
    """Return schema `pico.capture/v1`: `files`, `changes`, `written` and `patch`."""
    return {"schema": "pico.capture/v1", **as_json(captured)}
