"""What people noted on a part."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.history.lab.notes import Note
from pico.model.record import as_json

from .style import paint


def text(part: str, notes: Sequence[Note], added: Note | None) -> str:
    """Return the notes on a part, oldest first, or that one was added."""
    if added:
        return f"Noted on {part}: {added.text}\n`pico commit` takes it along."
    if not notes:
        return f'Nothing was noted on {part}: `pico note {part} "what there is to say"`'
    return "\n".join([f"{paint('bold', part)}:", *lines(notes)])


def lines(notes: Sequence[Note], indent: str = "  ") -> list[str]:
    """Return notes as lines: the day, what, who."""
    return [f"{indent}{n.day or '-':10}  {n.text}{paint('dim', f'  {n.author}') if n.author else ''}" for n in notes]


def data(part: str, notes: Sequence[Note], added: Note | None) -> dict[str, Any]:
    """Return schema `pico.notes/v1`: `part`, its `notes`, and the one that was `added`."""
    return {
        "schema": "pico.notes/v1",
        "part": part,
        "notes": as_json(tuple(notes)),
        "added": as_json(added) if added else None,
    }
