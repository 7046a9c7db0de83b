"""What an edge keeps of its gate for good, in `.pico/gate.sqlite`: the highest token that it fenced for, and what
became of each command. SQLite, WAL with synchronous=FULL: what was written is on the disk when its function returns."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pico.control.gate import Command, Memory, Phase, Record
from pico.diagnostics import PicoError, error
from pico.disk import refusing, unwritable

KEPT = 64
"""Of so many leases before the last one the commands are kept: the coordinator asks for none of an earlier one."""
_TABLES = """
CREATE TABLE IF NOT EXISTS fence (one INTEGER PRIMARY KEY CHECK (one = 1), token INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS commands (
  key TEXT PRIMARY KEY, token INTEGER NOT NULL, seq INTEGER NOT NULL, digest TEXT NOT NULL, phase TEXT NOT NULL,
  result TEXT NOT NULL
);
"""


class KeptGate:
    """The file of one bench; every method raises PicoError where it can't be read or written."""

    def __init__(self, path: Path) -> None:
        self._path = path
        with self._guarded():
            path.parent.mkdir(parents=True, exist_ok=True)
            self._db = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
            self._db.execute("PRAGMA journal_mode=WAL")
            self._db.execute("PRAGMA synchronous=FULL")
            self._db.executescript(_TABLES)

    def memory(self, first: int) -> Memory:
        """Return what is kept; where nothing is, the bench was fenced for `first` before it was enrolled."""
        with self._guarded():
            self._db.execute("INSERT OR IGNORE INTO fence VALUES (1, ?)", (first,))
            self._db.execute("UPDATE fence SET token = ? WHERE token < ?", (first, first))
            (token,) = self._db.execute("SELECT token FROM fence").fetchone()
            rows = self._db.execute("SELECT key, token, seq, digest, phase, result FROM commands").fetchall()
        memory = Memory(fenced=token)
        for key, given, seq, digest, phase, result in rows:
            memory = memory.with_record(Record(Command(given, seq, key, digest), _phase(phase), result))
        return memory

    def fence(self, token: int) -> None:
        """Keep that the bench is fenced for a token."""
        with self._guarded():
            self._db.execute("BEGIN IMMEDIATE")
            self._db.execute("UPDATE fence SET token = ?", (token,))
            self._db.execute("DELETE FROM commands WHERE token < ? AND phase != 'unknown'", (token - KEPT,))
            self._db.execute("COMMIT")

    def write(self, record: Record, *, durable: bool = True) -> None:
        """Keep what became of a command; not `durable`: on the disk with the next one that is, for the log is written
        in order."""
        command = record.command
        row = (command.key, command.token, command.seq, command.digest, record.phase, record.result)
        with self._guarded():
            self._db.execute(f"PRAGMA synchronous={'FULL' if durable else 'NORMAL'}")
            self._db.execute("INSERT OR REPLACE INTO commands VALUES (?, ?, ?, ?, ?, ?)", row)
            self._db.execute("PRAGMA synchronous=FULL")

    def close(self) -> None:
        """Let go of the file."""
        self._db.close()

    @contextmanager
    def _guarded(self) -> Iterator[None]:
        try:
            yield
        except (sqlite3.Error, OSError) as exc:
            what = f"what the edge lets through can't be kept in {self._path}"
            if type(exc) is sqlite3.DatabaseError:  # such as: the file is no database
                hint = f"move it away: `mv {self._path} {self._path}.broken`; the next lease begins it anew"
                raise PicoError(error("gate", f"{what}: it is damaged ({exc})", hint=hint)) from exc
            why = refusing(self._path.parent) or exc
            raise PicoError(unwritable(self._path, why, what=what, code="gate")) from exc


def _phase(text: str) -> Phase:
    found: Phase = text  # type: ignore[assignment]
    return found


def answer_of(record: Record) -> dict[str, object]:
    """Return what a command was answered, as it was."""
    found: dict[str, object] = json.loads(record.result)
    return found
