"""The one journal in which an earlier PICO kept the runs of all benches of a lab: of which bench each run is."""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Collection, Mapping
from contextlib import closing
from pathlib import Path

Damaged = sqlite3.Error
"""What a journal raises that can't be read."""
_BY_EVIDENCE = {"kinematic": "sim", "physics": "sim", "emulated": "emulated", "hardware": "hardware"}


def benches_of_runs(path: Path) -> dict[str, str | None]:
    """Return the bench of each run in a journal, in the order in which they began; None if that is unclear: the run
    says nothing of it, or was taken up again on another bench. Raises Damaged."""
    with closing(sqlite3.connect(path)) as journal:
        columns = {row[1] for row in journal.execute("PRAGMA table_info(runs)")}
        wanted = ", ".join(name if name in columns else "NULL" for name in ("document", "about"))
        order = "number" if "number" in columns else "started_at, run"
        rows = journal.execute(f"SELECT run, {wanted} FROM runs ORDER BY {order}").fetchall()
    return {run: _bench_of(document, about) for run, document, about in rows}


def _bench_of(document: str | None, about: str | None) -> str | None:
    """Return the bench that a run was on each time that it was begun or taken up again."""
    try:
        starts = json.loads(about) if about else []
        found = {_said(one) for one in starts if one} - {None}
        if not found and document:
            found = {json.loads(document).get("backend")} - {None}
    except (ValueError, TypeError, AttributeError):
        return None
    return str(found.pop()) if len(found) == 1 else None


def _said(start: Mapping[str, object]) -> str | None:
    environment = start.get("environment")
    backend = environment.get("backend") if isinstance(environment, dict) else None
    return str(backend) if backend else _BY_EVIDENCE.get(str(start.get("evidence")))


def copy_runs(path: Path, to: Path, runs: Collection[str]) -> None:
    """Write a journal that has only these runs of the one at `path`; it is on the disk when this returns. Raises
    Damaged, OSError."""
    with closing(sqlite3.connect(path)) as whole, closing(sqlite3.connect(to)) as part:
        whole.backup(part)
        part.execute("PRAGMA journal_mode=DELETE")
        part.execute("CREATE TEMP TABLE wanted (run TEXT PRIMARY KEY)")
        part.executemany("INSERT INTO wanted VALUES (?)", [(run,) for run in runs])
        for table in ("records", "runs"):
            part.execute(f"DELETE FROM {table} WHERE run NOT IN (SELECT run FROM wanted)")
        part.commit()
        part.execute("VACUUM")
    with to.open("rb") as file:
        os.fsync(file.fileno())
