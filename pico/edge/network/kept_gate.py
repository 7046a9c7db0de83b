"""What an edge keeps of its gate for good, in `.pico/gate.sqlite`: the highest token that it fenced for, and what
became of each command. SQLite, WAL with synchronous=FULL: what was written is on the disk when its function returns."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pico.base.database import EMPTY, is_emptied, make_database
from pico.base.plain_files import other_than_file
from pico.base.state_files import GATE
from pico.control.gate import Command, Memory, Phase, Record
from pico.diagnostics import PicoError, error
from pico.disk import refusing, unwritable
from pico.runs.damage import checksum

KEPT = 64
"""Of so many leases before the last one the commands are kept: the coordinator asks for none of an earlier one."""
_COLUMNS = "key, token, seq, digest, phase, result"
_TABLES = """
CREATE TABLE IF NOT EXISTS fence (one INTEGER PRIMARY KEY CHECK (one = 1), token INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS commands (
  key TEXT PRIMARY KEY, token INTEGER NOT NULL, seq INTEGER NOT NULL, digest TEXT NOT NULL, phase TEXT NOT NULL,
  result TEXT NOT NULL, checksum TEXT
);
"""


class KeptGate:
    """The file of one bench; every method raises PicoError where it can't be read or written."""

    def __init__(self, path: Path) -> None:
        self._path = path
        if what := other_than_file(path):
            raise PicoError(GATE.unreadable(path, f"it is {what}"))
        with self._guarded():
            path.parent.mkdir(parents=True, exist_ok=True)
            if is_emptied(path):
                raise sqlite3.DatabaseError(EMPTY)
            if not path.exists():
                make_database(path, _TABLES)
            self._db = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
            self._db.execute("PRAGMA journal_mode=WAL")
            self._db.execute("PRAGMA synchronous=FULL")
            self._db.executescript(_TABLES)
            self._db.text_factory = lambda data: data.decode("utf-8", "surrogateescape")  # a flipped bit is named below
            if "checksum" not in {row[1] for row in self._db.execute("PRAGMA table_info(commands)")}:
                self._db.execute("ALTER TABLE commands ADD COLUMN checksum TEXT")

    def memory(self, first: int) -> Memory:
        """Return what is kept; where nothing is, the bench was fenced for `first` before it was enrolled."""
        with self._guarded():
            self._db.execute("INSERT OR IGNORE INTO fence VALUES (1, ?)", (first,))
            self._db.execute("UPDATE fence SET token = ? WHERE token < ?", (first, first))
            (token,) = self._db.execute("SELECT token FROM fence").fetchone()
            rows = self._db.execute(f"SELECT {_COLUMNS}, checksum FROM commands").fetchall()
        memory = Memory(fenced=token)
        for *row, known in rows:
            if known is not None and known != checksum(*row):
                raise PicoError(GATE.damaged(self._path, f"the record of the command {row[0]!r} is damaged"))
            key, given, seq, digest, phase, result = row
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
            into = f"INSERT OR REPLACE INTO commands ({_COLUMNS}, checksum) VALUES (?, ?, ?, ?, ?, ?, ?)"
            self._db.execute(into, (*row, checksum(*row)))
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
                hint = f"move it away: `mv {self._path} {self._path}.damaged`; the next lease begins it anew"
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
