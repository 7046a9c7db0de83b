"""What blame has read before: a SQLite file in the folder that all worktrees share, never needed and never trusted.

A cache that is damaged, locked, read-only or another version's answers nothing and keeps nothing; no error leaves this
module. What it holds is derived from what Git holds, so it may be deleted at any time.
"""

from __future__ import annotations

import contextlib
import sqlite3
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

VERSION = 3
"""Of the tables and of what is in them; a file of another version is made anew."""
MOST_BYTES = 64 * 1024 * 1024
"""Beyond this the older half of what was read goes. A thousand commits to 40 files take about 1 MB."""
MOST_RESULTS = 40
"""So many answers are kept, the newest of all folders and branches together."""
_WAIT = 0.5
_TABLES = """
CREATE TABLE read (number INTEGER PRIMARY KEY, key TEXT UNIQUE, data BLOB);
CREATE TABLE result (number INTEGER PRIMARY KEY, lab TEXT, id TEXT, data BLOB, UNIQUE (lab, id));
"""


class Cache:
    """Texts by key: what files say (`read`), and what blame answered for a lab and a commit (`result`)."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._new: dict[str, bytes] = {}
        self._database = _open(path)

    def close(self) -> None:
        """Write what was put, as far as that is possible, and let go of the file."""
        self.flush()
        if self._database is not None:
            self._database.close()
            self._database = None

    def get(self, key: str) -> str | None:
        """Return the text at a key, None where it is not known."""
        return _text(self._new.get(key) or self._one("SELECT data FROM read WHERE key = ?", key))

    def put(self, key: str, text: str) -> None:
        """Keep a text for a key; written at the end."""
        self._new[key] = zlib.compress(text.encode(), 1)
        if len(self._new) >= 5000:
            self.flush()

    def results(self, lab: str) -> list[str]:
        """Return the commits of a lab with an answer, newest answer first."""
        rows = self._all("SELECT id FROM result WHERE lab = ? ORDER BY number DESC", lab)
        return [row[0] for row in rows if isinstance(row[0], str)]

    def result(self, lab: str, commit: str) -> str | None:
        """Return the answer for a commit of a lab, None where it is not known."""
        return _text(self._one("SELECT data FROM result WHERE lab = ? AND id = ?", lab, commit))

    def put_result(self, lab: str, commit: str, text: str) -> None:
        """Keep an answer; the oldest ones go."""
        add = "INSERT OR REPLACE INTO result (lab, id, data) VALUES (?, ?, ?)"
        old = "DELETE FROM result WHERE number NOT IN (SELECT number FROM result ORDER BY number DESC LIMIT ?)"
        self._write([(add, [(lab, commit, zlib.compress(text.encode(), 1))]), (old, [(MOST_RESULTS,)])])

    def flush(self) -> None:
        """Write what was put since the last time."""
        rows, self._new = list(self._new.items()), {}
        if rows:
            self._write([("INSERT OR IGNORE INTO read (key, data) VALUES (?, ?)", rows)])
        if rows and self._size() > MOST_BYTES:
            half = "DELETE FROM read WHERE number <= (SELECT (MIN(number) + MAX(number)) / 2 FROM read)"
            self._write([(half, [()]), ("DELETE FROM result", [()])])

    def _size(self) -> int:
        rows = self._all(
            "SELECT (p.page_count - f.freelist_count) * s.page_size "
            "FROM pragma_page_count p, pragma_freelist_count f, pragma_page_size s"
        )
        return int(rows[0][0]) if rows else 0

    def _one(self, query: str, *values: str) -> bytes | None:
        row = next(iter(self._all(query, *values)), None)
        return row[0] if row and isinstance(row[0], bytes) else None

    def _all(self, query: str, *values: str) -> list[tuple[Any, ...]]:
        if self._database is None:
            return []
        try:
            return self._database.execute(query, values).fetchall()
        except sqlite3.Error as exc:
            self._give_up(exc)
            return []

    def _write(self, statements: Iterable[tuple[str, list[tuple[Any, ...]]]]) -> None:
        if self._database is None:
            return
        try:
            with self._database:
                for statement, rows in statements:
                    self._database.executemany(statement, rows)
        except sqlite3.Error as exc:
            self._give_up(exc)

    def _give_up(self, exc: sqlite3.Error) -> None:
        """Go on without the file; one that is damaged is removed, so that the next call makes it anew."""
        assert self._database is not None
        with contextlib.suppress(sqlite3.Error):
            self._database.close()
        self._database = None
        if not isinstance(exc, sqlite3.OperationalError):
            _remove(self.path)


def _open(path: Path) -> sqlite3.Connection | None:
    for _ in range(2):
        database: sqlite3.Connection | None = None
        try:
            path.parent.mkdir(exist_ok=True)
            database = sqlite3.connect(path, timeout=_WAIT)
            database.execute("PRAGMA synchronous = OFF")
            if _ready(database):
                return database
            database.close()
        except (sqlite3.Error, OSError) as exc:
            if database is not None:
                database.close()
            if not isinstance(exc, sqlite3.DatabaseError) or isinstance(exc, sqlite3.OperationalError):
                return None
        _remove(path)
    return None


def _ready(database: sqlite3.Connection) -> bool:
    """Return whether the file has this version's tables, made here where it has none at all."""
    version = database.execute("PRAGMA user_version").fetchone()[0]
    tables = {name for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
    if version or tables:
        return bool(version == VERSION and tables >= {"read", "result"})
    database.executescript(f"BEGIN IMMEDIATE; {_TABLES} PRAGMA user_version = {VERSION}; COMMIT;")
    return True


def _remove(path: Path) -> None:
    for name in (path.name, f"{path.name}-journal"):
        with contextlib.suppress(OSError):
            path.with_name(name).unlink(missing_ok=True)


def _text(data: bytes | None) -> str | None:
    try:
        return zlib.decompress(data).decode() if data is not None else None
    except (zlib.error, UnicodeDecodeError):
        return None
