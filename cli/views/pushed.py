"""What `pico push` sent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.history.data.transfer import Moved
from pico.history.repository.remote import Pushed
from pico.model.record import as_json

from . import data as said
from .style import columns


def text(sent: Sequence[Pushed], moved: Moved | None) -> str:
    """Return a line about the data, where there was any, and one a ref."""
    rows = [(_short(p.ref), "→", _short(p.there), p.summary) for p in sent]
    first = [f"Sent {said.objects(moved.objects)} to {moved.place}."] if moved and moved.objects else []
    return "\n".join([*first, *(columns(rows) or ["Sent no commits: git had nothing to send."])])


def data(sent: Sequence[Pushed], moved: Moved | None) -> dict[str, Any]:
    """Return schema `pico.push/v1`: `refs`, and `data` where a place for it is known."""
    found = {"data": as_json(moved)} if moved else {}
    return {"schema": "pico.push/v1", "refs": [as_json(p) for p in sent], **found}


def _short(ref: str) -> str:
    return ref.removeprefix("refs/heads/").removeprefix("refs/tags/")
