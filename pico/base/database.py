"""Databases that come into being whole: an empty file is always one that lost what it held, never one in the making."""

from __future__ import annotations

import glob
import os
import sqlite3
import threading
from contextlib import closing
from pathlib import Path

from pico.disk import removed, sweep

EMPTY = "the file is empty"


def is_emptied(path: Path) -> bool:
    """Return whether a database is an empty file: something emptied it, for none is made so."""
    try:
        return path.stat().st_size == 0
    except OSError:
        return False


def make_database(path: Path, script: str) -> None:
    """Make a SQLite database that holds what a script writes, with a write-ahead log, if there is none at `path`.

    It is written beside `path` and linked there, so that other processes see no file or all of it, and the first of
    several that make it at the same time wins. Raises OSError and sqlite3.Error.
    """
    sweep(path.parent, glob.escape(path.name))
    fresh = path.with_name(f".{path.name}.{threading.get_ident()}.{os.getpid()}.tmp")
    with removed(fresh):
        fresh.unlink(missing_ok=True)
        with closing(sqlite3.connect(fresh, isolation_level=None)) as db:
            db.execute("PRAGMA synchronous=FULL")
            db.executescript(script)
            db.execute("PRAGMA journal_mode=WAL")
        try:
            os.link(fresh, path)
        except FileExistsError:
            pass
        except OSError:  # a disk without hard links
            if not path.exists():
                fresh.replace(path)
        fresh.unlink(missing_ok=True)
