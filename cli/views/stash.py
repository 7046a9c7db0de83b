"""Edits that are shelved, and that the bench is not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.history.restoring.stash import Shelf
from pico.model.record import as_json

from .diff import brief, lines
from .style import columns, count, paint, wrap


def text(action: str, shelves: Sequence[Shelf], *, apart: tuple[int, int] | None = None) -> str:
    """Return what was shelved or brought back, how the bench stands to the files now, and how to go back."""
    if action == "list":
        return _list(shelves)
    if not shelves:
        return "Nothing to shelve: the manifests are as in the last commit."
    (shelf,) = shelves
    changes = lines(shelf.changes) or ["  no change on the table"]
    if action == "drop":
        keep = f"git stash store -m 'again' {shelf.commit}"
        return "\n".join([f"Dropped: {shelf.message}", *changes, f"Go back with `{keep}`."])
    head = "Shelved" if action == "push" else "Brought back"
    back = "pico stash pop" if action == "push" else "pico stash"
    what = "The files are shelved, the bench is not" if action == "push" else "Only files changed"
    said = wrap(f"{what}: nothing moved. {_bench(apart)}", "")
    return "\n".join([f"{head}:", *changes, "", *said, f"Go back with `{back}`."])


def _bench(apart: tuple[int, int] | None) -> str:
    if apart is None:
        return ""
    number, of = apart
    if not number:
        return "The bench is as the manifest says."
    verb = "differs" if number == 1 else "differ"
    return f"{number} of {count(of, 'component')} {verb} from the manifest now: `pico plan` shows how."


def _list(shelves: Sequence[Shelf]) -> str:
    if not shelves:
        return "Nothing is shelved."
    return "\n".join(columns([_row(shelf) for shelf in shelves]))


def _row(shelf: Shelf) -> list[str]:
    what = brief(shelf.changes)
    return [paint("yellow", str(shelf.number)), shelf.message, "" if what in shelf.message else paint("dim", what)]


def data(action: str, shelves: Sequence[Shelf], *, apart: tuple[int, int] | None = None) -> dict[str, Any]:
    """Return schema `pico.stash/v1`: `action`, `shelves`, and how many components are `apart` from the manifest."""
    found: dict[str, Any] = {"schema": "pico.stash/v1", "action": action, "shelves": as_json(shelves)}
    return found | ({"apart": apart[0], "components": apart[1]} if apart else {})
