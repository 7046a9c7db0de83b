"""A damaged journal, read row by row, and a new one made of what is intact and of what commits hold."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pico.base.database import EMPTY, is_emptied
from pico.base.plain_files import aside_of, other_than_file, remove_file
from pico.base.state_files import CHANGE_COUNT, JOURNAL
from pico.diagnostics import PicoError
from pico.disk import writing
from pico.model.operation import operation_from_json
from pico.model.record import digest
from pico.runs.damage import (
    PHASES,
    FromCommit,
    checksum,
    is_sound_head,
    is_sound_part,
    is_sound_record,
    marked_run,
    sums_of_run,
)
from pico.runs.journal import Journal, as_text
from pico.runs.storage.change_count import ChangeCount
from pico.runs.storage.journal_tables import HEAD, ROW
from pico.runs.storage.write_ahead import lost_transactions

MOST = 10_000_000
"""Rows that are tried one by one at most if a table can't be read from its beginning to its end."""
ENDS = ("done", "failed", "unknown")
"""How an operation ends, as records and the tally of a run have it."""
Rows = list[tuple[Any, ...]]


@dataclass
class Examined:
    """A journal as it was found."""

    runs: Rows = field(default_factory=list)
    """Rows of runs: number, run, plan, holder, started_at, finished_at, outcome, tally, resumed, document, about, seen,
    checksum."""
    records: Rows = field(default_factory=list)
    """Rows of records: seq, key, run, phase, kind, component, digest, token, at, data, checksum."""
    fence: int = 0
    """The highest token that was let through."""
    broken: str = ""
    """What is wrong with the file as a whole; empty if nothing is."""
    missing: str = ""
    """A run that has begun by its mark and is not in the journal."""

    def damaged(self) -> dict[str, list[str]]:
        """Return what of each run is damaged, by its id as it is read."""
        found: dict[str, list[str]] = {}
        for row in self.runs:
            for part in _damaged_parts(row):
                found.setdefault(str(row[1]), []).append(part)
        for row in self.records:
            if not is_sound_record(row):
                found.setdefault(str(row[2]), []).append(f"record {row[0]} ({row[4]} of {row[5]})")
        known = {row[1] for row in self.runs}
        for run in {str(row[2]) for row in self.records} - known:
            found.setdefault(run, []).append("the beginning of the run is missing")
        if self.missing:
            found.setdefault(self.missing, []).append("all of it is missing")
        return found


@dataclass(frozen=True)
class Lost:
    """A run that no commit has and of which something is damaged, so that the new journal leaves it out."""

    run: str
    started_at: str
    what: tuple[str, ...]


@dataclass(frozen=True)
class Salvage:
    """What a new journal is made of."""

    runs: Rows
    records: Rows
    fence: int
    intact: int
    """Runs that are as they were."""
    from_commits: tuple[str, ...]
    """Runs of which something was taken from commits."""
    lost: tuple[Lost, ...]


def examine(path: Path) -> Examined:
    """Return all that can be read of the journal at `path`; the file and what lies beside it stay untouched. Raises
    PicoError if they can't be copied."""
    marked, least = marked_run(path), ChangeCount(path).least()
    if what := other_than_file(path):
        return Examined(broken=f"it is {what}", missing=marked)
    for name in (f"{path.name}-wal", f"{path.name}-shm"):
        if what := other_than_file(path.with_name(name)):
            raise PicoError(JOURNAL.unreadable(path.with_name(name), f"it is {what}"))
    if not path.exists() or is_emptied(path):
        return Examined(broken=EMPTY if path.exists() else "the file is gone", missing=marked)
    lost = lost_transactions(path)
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / path.name
        with writing(copy):
            for suffix in ("", "-wal"):
                if (one := path.with_name(path.name + suffix)).exists():
                    shutil.copyfile(one, copy.with_name(copy.name + suffix))
        try:
            with closing(sqlite3.connect(copy)) as db:
                db.text_factory = lambda data: data.decode("utf-8", "surrogateescape")
                found = _read(db)
                missing = least - _changes(db)
        except sqlite3.Error as exc:
            return Examined(broken=str(exc), missing=marked)
    if lost:
        found.broken = f"its write-ahead log is damaged, and {lost} transactions behind that are lost"
    elif missing > 0:
        found.broken = found.broken or f"its last {missing} changes are missing"
    open_end = not found.runs or found.runs[-1][5] is None  # then the mark may be what is damaged
    if marked not in {row[1] for row in found.runs} and (found.broken or not open_end or not found.runs):
        found.missing = marked
    return found


def _read(db: sqlite3.Connection) -> Examined:
    wrong = ""
    try:
        said = db.execute("PRAGMA integrity_check(1)").fetchone()[0]
        wrong = "" if said == "ok" else str(said)
    except sqlite3.Error as exc:
        wrong = str(exc)
    runs, torn_runs = _rows(db, "runs", f"{HEAD}, document, about, seen", "number")
    records, torn_records = _rows(db, "records", ROW, "seq")
    fence = 0
    with suppress(sqlite3.Error, TypeError):
        fence = int(db.execute("SELECT token FROM fence").fetchone()[0])
    return Examined(runs, records, fence, wrong or torn_runs or torn_records)


def _rows(db: sqlite3.Connection, table: str, columns: str, number: str) -> tuple[Rows, str]:
    """Return the rows of a table that can be read, and what SQLite said of the others."""
    try:
        there = {row[1] for row in db.execute(f"PRAGMA table_info({table})")}
    except sqlite3.Error as exc:
        return [], str(exc)
    if not there:
        return [], f"there is no table {table}"
    names = ", ".join(name if name in there else "NULL" for name in f"{columns}, checksum".split(", "))
    found: Rows = []
    try:
        for row in db.execute(f"SELECT {names} FROM {table} NOT INDEXED ORDER BY {number}"):
            found.append(tuple(row))
    except sqlite3.Error as exc:
        return [*found, *_one_by_one(db, f"SELECT {names} FROM {table} WHERE {number} = ?", table, found)], str(exc)
    return found, ""


def _one_by_one(db: sqlite3.Connection, query: str, table: str, found: Rows) -> Iterator[tuple[Any, ...]]:
    first = found[-1][0] + 1 if found else 1
    last = first + 1000
    with suppress(sqlite3.Error, TypeError):
        last = int(db.execute("SELECT seq FROM sqlite_sequence WHERE name = ?", (table,)).fetchone()[0])
    for number in range(first, min(last, MOST) + 1):
        with suppress(sqlite3.Error):
            if (row := db.execute(query, (number,)).fetchone()) is not None:
                yield tuple(row)


def salvage(found: Examined, known: Callable[[str], FromCommit | None], committed: Iterable[str]) -> Salvage:
    """Return what a new journal is made of: the runs that are intact, and what `known` has of the others by commits.

    `committed`: runs of the bench that commits hold; those that the journal has lost whole are taken, too.
    """
    wrong = found.damaged()
    own: dict[str, Rows] = {}
    for row in found.records:
        own.setdefault(str(row[2]), []).append(row)
    runs, records = list[tuple[Any, ...]](), list[tuple[float, tuple[Any, ...]]]()
    mended, lost = list[str](), list[Lost]()
    present = {str(row[1]): row for row in found.runs}
    if found.broken:  # rows of the unreadable part are missing, and nothing else says so
        for run, row in present.items():
            if run not in wrong and not _is_complete(row, own.get(run, []), known(run)):
                wrong[run] = ["records of it are missing"]
    gone = wrong.keys() | set(committed if found.broken else ())
    for run in (*present, *sorted(gone - present.keys())):
        there, rows = present.get(run), own.get(run, [])
        if run not in wrong and there is not None:
            runs.append(there)
            records += [(float(one[0]), one) for one in rows]
        elif (held := known(run)) is not None:
            runs.append(_run_of(there, held))
            records += _records_of(rows, held)
            mended.append(run)
        else:
            lost.append(Lost(run, str(there[4]) if there else "", tuple(wrong.get(run, ()))))
    ordered = [one for _, one in sorted(records, key=lambda one: one[0])]
    return Salvage(sorted(runs, key=_order), _distinct(ordered), found.fence,
                   len(runs) - len(mended), tuple(mended), tuple(lost))  # fmt: skip


def _distinct(records: Rows) -> Rows:
    """Return records without those that a torn table, or a commit beside it, holds twice: a sound one comes first."""
    found: dict[tuple[Any, Any], tuple[Any, ...]] = {}
    for row in records:
        place = row[1], row[3]  # key and phase
        if place not in found or (is_sound_record(row) and not is_sound_record(found[place])):
            found[place] = row
    return list(found.values())


def _is_complete(row: Sequence[Any], rows: Rows, held: FromCommit | None) -> bool:
    """Return whether all records of a run are there: as many as its commit has, or as many ends as it counted."""
    if held is not None:
        return len(rows) >= len(held.records)
    ended = {(one[1].split("/")[1]) for one in rows if one[4] in ENDS}
    phases = {(one[1], one[3]) for one in rows}
    whole = all((key, phase - 1) in phases for key, phase in phases if phase)
    tally = json.loads(row[7]) if row[7] else None
    counted = sum(tally.get(how, 0) for how in ENDS) if isinstance(tally, dict) else None
    return whole and counted == len(ended)


def _damaged_parts(row: Sequence[Any]) -> Iterator[str]:
    if not is_sound_head(row[:9], row[12]):
        yield "its beginning and end"
    for part, value, name in zip(("document", "about", "seen"), row[9:12], ("plan", "origin", "outcome"), strict=True):
        if not is_sound_part(value, row[12], part):
            yield f"its {name}"


def _order(row: Sequence[Any]) -> tuple[int, str]:
    return int(row[0] or 0), str(row[4])


def _run_of(row: tuple[Any, ...] | None, held: FromCommit) -> tuple[Any, ...]:
    """Return the row of a run: its sound parts, and the others as a commit has them."""
    number, run, plan, holder, started, finished, outcome, tally, resumed = held.head
    head: tuple[Any, ...] = (number, run, plan, holder, started, finished, outcome, as_text(tally), resumed)
    parts: tuple[Any, ...] = (None, as_text(held.about), as_text(held.seen) if held.seen else None)
    if row is not None:
        head = row[:9] if is_sound_head(row[:9], row[12]) else (row[0], *head[1:])
        names = ("document", "about", "seen")
        parts = tuple(
            mine if is_sound_part(mine, row[12], name) else theirs
            for mine, theirs, name in zip(row[9:12], parts, names, strict=True)
        )
    return (*head, *parts, None)


def _records_of(rows: Rows, held: FromCommit) -> list[tuple[float, tuple[Any, ...]]]:
    """Return the records of a run with where each belongs: the sound ones, and for the others those of a commit."""
    sound = {(row[1], row[4]): row for row in rows if is_sound_record(row)}
    free = [float(row[0]) for row in rows if not is_sound_record(row)]
    contents = {one[0]: digest(operation_from_json(one[4])) for one in held.records if one[1] == "intent"}
    found, last = list[tuple[float, tuple[Any, ...]]](), float(rows[0][0]) - 0.5 if rows else 0.0
    for key, kind, component, at, data in held.records:
        if (key, kind) in sound:
            row = sound.pop((key, kind))
            last = float(row[0])
        else:
            last = free.pop(0) if free else last + 1e-6
            run = key.partition("/")[0]
            row = (0, key, run, PHASES[kind], kind, component, contents.get(key, ""), 0, at, as_text(data), None)
        found.append((last, row))
    return found + [(float(row[0]), row) for row in sound.values()]


def _changes(db: sqlite3.Connection) -> int:
    """Return how often a journal was written to; of one that does not count that, more than ever."""
    try:
        return int(db.execute("SELECT changes FROM fence").fetchone()[0])
    except (sqlite3.Error, TypeError, ValueError):
        return sys.maxsize


def write_journal(made: Salvage, path: Path) -> None:
    """Write a journal of what was salvaged to `path`, where none is; it is on the disk when this returns. Raises
    PicoError."""
    Journal(path).close()
    with writing(path):
        try:
            with closing(sqlite3.connect(path)) as db:
                rows = [row[:12] for row in made.runs]
                if len({row[0] for row in rows} - {None}) < len(rows):  # of a torn page: their order counts
                    rows = [(number, *row[1:]) for number, row in enumerate(rows, 1)]
                whole = [(*row, sums_of_run(row)) for row in rows]
                db.executemany(
                    f"INSERT INTO runs ({HEAD}, document, about, seen, checksum) VALUES ({_marks(13)})", whole
                )
                records = [(*row[1:10], checksum(*row[1:10])) for row in made.records]
                columns = ROW.partition(", ")[2]
                db.executemany(f"INSERT INTO records ({columns}, checksum) VALUES ({_marks(10)})", records)
                db.execute("UPDATE fence SET token = ?", (made.fence,))
                db.commit()
                db.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        except sqlite3.Error as exc:
            raise OSError(str(exc)) from exc


def _marks(count: int) -> str:
    return ", ".join("?" * count)


def replace_journal(path: Path, new: Path) -> Path | None:
    """Put a journal in the place of the damaged one, which is set aside under a name that is free; return that name, or
    None if the damaged one was gone. Raises PicoError."""
    aside, gone = aside_of(path), not os.path.lexists(path)
    with writing(path):
        if other_than_file(path):
            path.rename(aside)
        elif path.exists():
            os.link(path, aside)
        for suffix in ("-wal", "-shm"):  # before the new one takes the place: SQLite would play the old log into it
            if (one := path.with_name(path.name + suffix)).exists():
                one.rename(aside.with_name(aside.name + suffix))
        remove_file(CHANGE_COUNT.path(path.parent))  # of the damaged one
        new.replace(path)
    return None if gone else aside
