"""A merge that was made."""

from __future__ import annotations

from typing import Any

from pico.history.merge.commits import MergeMade
from pico.model.record import as_json

from .diff import lines
from .style import count


def text(made: MergeMade) -> str:
    """Return what came of it, with what it changed on the table against the branch as it was."""
    if made.kind == "up-to-date":
        return f"{made.name} holds nothing that is not here already."
    head = f"Merged {made.name}" if made.kind == "merged" else f"Went on to {made.name}: nothing was to be united"
    what = f"{count(len(made.changes), 'tunable')} changed here" if made.changes else "nothing changed on the table"
    block = [f"{head} ({made.commit[:7]}); {what}.", *lines(made.changes)]
    if made.kind == "merged":
        block += ["", "Nothing moved. `pico plan` shows what the bench still has to do."]
    return "\n".join(block)


def data(made: MergeMade) -> dict[str, Any]:
    """Return schema `pico.merge/v1`."""
    return {"schema": "pico.merge/v1", **as_json(made)}
