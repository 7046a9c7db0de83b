"""The inventory and where it is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.model.record import as_json
from pico.model.trace.report import PartRow

from .style import columns, count, paint


def text(rows: Sequence[PartRow], *, free: bool) -> str:
    """Return a line a part."""
    if not rows:
        return "No part is free." if free else "The inventory is empty."
    head = [paint("dim", cell) for cell in ("part", "type", "marker", "home", "where it is")]
    table = [
        [r.name, r.title or r.type, "-" if r.marker is None else str(r.marker), r.home or "fixed",
         (r.where or paint("red", "not seen")) + (paint("green", "  free") if r.free and not free else "")]
        for r in rows
    ]  # fmt: skip
    unused = sum(r.free for r in rows)
    return "\n".join([*columns([head, *table]), "", f"{count(len(rows), 'part')}, {unused} free"])


def data(rows: Sequence[PartRow], **_: Any) -> dict[str, Any]:
    """Return schema `pico.parts/v1`: `parts`."""
    return {"schema": "pico.parts/v1", "parts": as_json(rows)}
