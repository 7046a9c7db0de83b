"""What an import took in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import columns, count, paint

if TYPE_CHECKING:
    from pico.bench.importing import Imported


def text(found: Imported, *, dry_run: bool) -> str:
    """Return a line a part, and which files were written."""
    if not found.parts:
        return "Nothing to import: every marker on the table is in the inventory."
    head = [paint("dim", cell) for cell in ("part", "type", "marker", "home", "stands")]
    rows = [[p.name, p.type, str(p.marker), p.home, str(p.pose) if p.pose else f"in {p.slot}"] for p in found.parts]
    files = " and ".join(found.files)
    said = f"{'Would write' if dry_run else 'Wrote'} {count(len(found.parts), 'part')} into {files}."
    next_step = "" if dry_run else " `pico validate` checks it, `pico commit` keeps it."
    return "\n".join([*columns([head, *rows]), "", said + next_step])


def data(found: Imported, *, dry_run: bool) -> dict[str, Any]:
    """Return schema `pico.import/v1`: `parts` (name, type, marker, home, slot or pose), `files`, `dry_run`."""
    return {"schema": "pico.import/v1", **as_json(found), "dry_run": dry_run}
