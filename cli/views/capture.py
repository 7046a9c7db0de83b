"""What `pico capture` wrote."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pico.model.diff import Change
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
    light = aligned(captured.changes, captured.aligned)
    what = f"{count(len(captured.changes), 'tunable')} into {where}:"
    if not captured.written:
        block = [f"Would write {what}", "", *lines(captured.changes), "", captured.patch.rstrip("\n")]
        return "\n".join([*block, "", "Nothing was written; `pico capture` without --dry-run does it."])
    last = '`git diff` shows the lines; `pico commit -m "why"` keeps it.'
    return "\n".join([f"Captured {what}", "", *lines(captured.changes), *light, last, *([kept] if kept else [])])


def aligned(changes: Sequence[Change], goals: Mapping[str, Sequence[str]] | None) -> list[str]:
    """Return a line for each goal whose values were written: `Wrote the aligned values of g: m1.tip -1.078 mrad.`"""
    texts = {f"{c.component}.{c.tunable}": c.text.rpartition("→ ")[2] for c in changes}
    return [
        f"Wrote the aligned values of {goal}: {', '.join(f'{a} {texts[a]}' for a in addresses)}."
        for goal, addresses in (goals or {}).items()
    ]


def data(captured: Captured) -> dict[str, Any]:
    """Return schema `pico.capture/v1`: `files`, `changes`, `written`, `patch`, `by_light` and `aligned`."""
    return {"schema": "pico.capture/v1", **as_json(captured)}
