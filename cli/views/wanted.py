"""What `--manifest` wrote of what somebody asks for, while the bench stays as it is."""

from __future__ import annotations

from pico.model.trace.report import Captured

from . import capture
from .diff import lines
from .style import count, listed


def text(wanted: Captured) -> str:
    """Return which tunables changed in which files."""
    if not wanted.changes:
        return "Nothing to write: the manifest says so already."
    what = f"{count(len(wanted.changes), 'tunable')} in {listed(wanted.files)}:"
    block = ["", *lines(wanted.changes), ""]
    if not wanted.written:
        return "\n".join([f"Would write {what}", *block, wanted.patch.rstrip("\n"), "", "Nothing was written."])
    return "\n".join(
        [f"Wrote {what}", *block, "The bench stays as it is; `pico plan` shows what `pico apply` would move."]
    )


data = capture.data
