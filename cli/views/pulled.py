"""What `pico pull` brought."""

from __future__ import annotations

from typing import Any

from pico.history.data.transfer import Moved
from pico.model.record import as_json

from . import data as said


def text(before: str | None, after: str | None, moved: Moved | None) -> str:
    """Return a line about the commits, one about the data where there was any, and what comes next."""
    block = ["Nothing new."]
    if before != after:
        block = [f"{(before or 'nothing')[:7]}..{(after or '')[:7]}; nothing moved: `pico plan` shows what would."]
    if moved and moved.objects:
        block.append(f"Fetched {said.objects(moved.objects)} from {moved.place}.")
    return "\n".join(block)


def data(before: str | None, after: str | None, moved: Moved | None) -> dict[str, Any]:
    """Return schema `pico.pull/v1`: the commits checked out `before` and `after`; `data` where its place is known."""
    found = {"data": as_json(moved)} if moved else {}
    return {"schema": "pico.pull/v1", "before": before, "after": after, **found}
