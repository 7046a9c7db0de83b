"""What was taken from a revision into the manifests, for single components."""

from __future__ import annotations

from typing import Any

from pico.history.restoring.selected import SelectedParts
from pico.model.record import as_json

from .diff import lines
from .style import listed


def text(taken: SelectedParts) -> str:
    """Return what the manifests say now that they did not say before, and which files were written."""
    if not taken.changes:
        return f"The manifest has {listed(taken.names)} as in {taken.revision} already."
    head = f"Taken from {taken.revision} into {listed(sorted(taken.files))}:"
    return "\n".join([head, *lines(taken.changes)])


def goal(name: str) -> str:
    """Return what a plan leads to: `part of e1 (E1-3 "p2 tilted")`; its scope says which."""
    return f"part of {name}"


def next_step(taken: SelectedParts, *, files_only: bool = False) -> str:
    """Return how to keep it and how to go back; nothing where nothing was written."""
    if not taken.changes:
        return ""
    if taken.revision in ("HEAD", "@"):
        return "The edits are gone." + ("" if files_only else " The bench goes back with `pico undo`.")
    option = "--files-only " if files_only else ""
    planned = " --planned" if files_only else ""
    back = f"pico checkout HEAD {option}-- {' '.join(taken.names)}"
    return f"Keep it: `pico commit{planned}`. Go back with `{back}`."


def data(what: SelectedParts | str, *, commit: str | None) -> dict[str, Any]:
    """Return schema `pico.checkout/v1`: `revision`, `commit` at HEAD now, `names`, `files` written, `changes`."""
    if isinstance(what, str):
        return {"schema": "pico.checkout/v1", "revision": what, "commit": commit}
    found = {"revision": what.revision, "commit": commit, "names": what.names, "files": sorted(what.files)}
    return {"schema": "pico.checkout/v1", **found, "changes": as_json(what.changes)}
