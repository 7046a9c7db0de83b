"""What was under way when a process was killed, from all that a journal holds."""

from __future__ import annotations

from pico.runs.journal import Journal, JournalRecord


def unfinished(journal: Journal) -> tuple[JournalRecord, ...]:
    """Return the `started` records without an end."""
    records = journal.records()
    over = {r.key for r in records if r.kind not in ("intent", "started")}
    return tuple(r for r in records if r.kind == "started" and r.key not in over)
