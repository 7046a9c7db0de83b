"""The tables of a journal in SQLite, and how those of earlier versions become those of today."""

from __future__ import annotations

from collections.abc import Mapping

VERSION = 5
"""The version of these tables, as `PRAGMA user_version` has it."""
ROW = "seq, key, run, phase, kind, component, digest, token, at, data"
"""The columns of a record, without its checksum."""
HEAD = "number, run, plan, holder, started_at, finished_at, outcome, tally, resumed"
"""The short columns of a run."""
_RUNS = """
CREATE TABLE IF NOT EXISTS runs (
  number INTEGER PRIMARY KEY AUTOINCREMENT, run TEXT NOT NULL UNIQUE, plan TEXT NOT NULL, holder TEXT NOT NULL,
  started_at TEXT NOT NULL, finished_at TEXT, outcome TEXT, tally TEXT, document TEXT, resumed INTEGER DEFAULT 0,
  about TEXT, seen TEXT, checksum TEXT
);
CREATE TABLE IF NOT EXISTS fence (one INTEGER PRIMARY KEY CHECK (one = 1), token INTEGER NOT NULL);
INSERT OR IGNORE INTO fence (one, token) VALUES (1, 0);
"""
_COUNTED = "".join(
    f"CREATE TRIGGER IF NOT EXISTS {change}_{table} AFTER {change} ON {table}"
    " BEGIN UPDATE fence SET changes = changes + 1; END;"
    for change, table in (("INSERT", "records"), ("INSERT", "runs"), ("UPDATE", "runs"))
)
_FROM_4 = f"ALTER TABLE fence ADD COLUMN changes INTEGER NOT NULL DEFAULT 0; {_COUNTED}"
"""Counts what is written, see `pico.runs.storage.change_count`."""
_FROM_1 = f"""
ALTER TABLE runs RENAME TO old_runs;
{_RUNS}
INSERT INTO runs (run, plan, holder, started_at, finished_at, outcome, tally)
  SELECT run, plan, holder, started_at, finished_at, outcome, tally FROM old_runs ORDER BY started_at, run;
DROP TABLE old_runs;
ALTER TABLE records ADD COLUMN checksum TEXT;
{_FROM_4}
"""
_FROM_3 = f"ALTER TABLE runs ADD COLUMN checksum TEXT; ALTER TABLE records ADD COLUMN checksum TEXT; {_FROM_4}"
_FROM_2 = f"ALTER TABLE runs ADD COLUMN about TEXT; ALTER TABLE runs ADD COLUMN seen TEXT; {_FROM_3}"
_TABLES = f"""
{_RUNS}
CREATE TABLE IF NOT EXISTS records (
  seq INTEGER PRIMARY KEY AUTOINCREMENT, key TEXT NOT NULL, run TEXT NOT NULL, phase INTEGER NOT NULL,
  kind TEXT NOT NULL, component TEXT NOT NULL, digest TEXT NOT NULL, token INTEGER NOT NULL, at TEXT NOT NULL,
  data TEXT NOT NULL, checksum TEXT, UNIQUE (key, phase)
);
CREATE INDEX IF NOT EXISTS records_of_run ON records (run);
{_FROM_4}
"""
SCRIPTS: Mapping[int, str] = {0: _TABLES, 1: _FROM_1, 2: _FROM_2, 3: _FROM_3, 4: _FROM_4}
"""What brings a journal of an earlier version to this one; 0: a new file."""
