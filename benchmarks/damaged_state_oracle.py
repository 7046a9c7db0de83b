"""What `damaged_state.py` compares: benches, commits and texts, read without PICO."""

from __future__ import annotations

import json
import re
import shutil
import sqlite3
import subprocess
import tempfile
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

BROKEN = re.compile(r"Traceback|\[internal\]|PICO itself failed|mistake in PICO|Exception ignored|JSONDecodeError")
RUN = re.compile(r"\d{8}T\d{6}Z-[0-9a-f]{6}")
NEW = "NEWRUN"
_DRIFTING = (
    (re.compile(r"(?m)^(note\[slow\].*|\d+ (note|warning)s?(, \d+ notes?)?)$| of about [\d.]+ s\b"), ""),
    (re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d(\.\d+)?)?( UTC|Z)?"), "TIME"),
    (re.compile(r"\b\d+(\.\d+)? ?(s|ms|min|h|seconds|minutes|hours)\b( ago)?"), "AGE"),
    (re.compile(r"just now|a (minute|moment) ago"), "AGE"),
    (re.compile(r"\b[0-9a-f]{7,40}\b"), "HEX"),
    (re.compile(r"\b\d\d:\d\d\b"), "TIME"),
    (re.compile(r" +"), " "),
)


def text_of(text: str, known: frozenset[str]) -> str:
    """Return a text without what differs between two calls: ages, times, and runs that are not among `known`."""
    text = RUN.sub(lambda m: m[0] if m[0] in known else NEW, text)
    for pattern, word in _DRIFTING:
        text = pattern.sub(word, text)
    return "\n".join(line.strip() for line in text.splitlines() if line.strip())


@dataclass(frozen=True)
class WorldPrint:
    """Where parts of a simulated table stand and how their tunables are set; None without a readable file."""

    parts: dict[str, Any] | None
    robots: Any = None
    clock: float = 0.0

    @property
    def is_light_out(self) -> bool:
        """Whether a laser emits through an open shutter."""
        values = [part.get("values", {}) for part in (self.parts or {}).values()]
        return any(_value(v, "emission") is True and _value(v, "shutter") == "open" for v in values)

    def without_light(self) -> dict[str, Any]:
        """Return the parts, less the emission and shutters of lasers."""
        return {
            name: part | {"values": {k: v for k, v in part["values"].items() if k not in ("emission", "shutter")}}
            for name, part in (self.parts or {}).items()
        }

    def equals(self, other: WorldPrint) -> bool:
        """Return whether nothing stands or is set elsewhere; a laser may be shut that was open, not the reverse."""
        return self.without_light() == other.without_light() and self.is_light_out <= other.is_light_out


def _value(values: Any, name: str) -> Any:
    return (values.get(name) or {}).get("value")


def world_print(bench: Path) -> WorldPrint:
    """Return the world of the bench whose folder this is."""
    try:
        found = json.loads((bench / "world.json").read_text())
        return WorldPrint(_rounded(found["components"]), _rounded(found.get("robots")), found["clock"])
    except (OSError, ValueError, KeyError, TypeError):
        return WorldPrint(None)


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _rounded(v) for k, v in value.items()}
    if isinstance(value, list):
        return [_rounded(v) for v in value]
    return round(value, 3) if isinstance(value, float) else value


def document(data: bytes) -> Any:
    """Return what a JSON file holds beside its checksum; None if it is none."""
    try:
        found = json.loads(data)
        found.pop("sha256", None)
    except (ValueError, AttributeError):
        return None
    return found


def runs_of(bench: Path) -> frozenset[str]:
    """Return the runs in the journal of a bench, none if it can't be read."""
    try:
        with closing(sqlite3.connect(f"file:{bench / 'journal.sqlite'}?mode=ro", uri=True)) as db:
            return frozenset(row[0] for row in db.execute("SELECT run FROM runs"))
    except sqlite3.Error:
        return frozenset()


def rows(journal: Path) -> int | None:
    """Return how many rows SQLite finds in a copy of a journal and its log; None if it can't read them."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "journal.sqlite"
        for suffix in ("", "-wal"):
            if (one := journal.with_name(f"journal.sqlite{suffix}")).exists():
                shutil.copyfile(one, f"{copy}{suffix}")
        try:
            with closing(sqlite3.connect(copy)) as db:
                queries = (f"SELECT count(*) FROM {table}" for table in ("runs", "records"))
                return sum(int(db.execute(query).fetchone()[0]) for query in queries)
        except sqlite3.Error:
            return None


def ended(bench: Path) -> int:
    """Return how many operations of a bench have ended, by its journal."""
    with closing(sqlite3.connect(f"file:{bench / 'journal.sqlite'}?mode=ro", uri=True)) as db:
        return int(db.execute("SELECT count(*) FROM records WHERE phase = 2").fetchone()[0])


def committed(lab: Path) -> tuple[int, str, int]:
    """Return the number of commits of HEAD, the state that it holds, and how many runs it holds."""

    def git(*words: str) -> str:
        done = subprocess.run(["git", *words], cwd=lab, capture_output=True, text=True, check=False)
        return done.stdout.strip()

    runs = sum(name.endswith("/run.json") for name in git("ls-tree", "-r", "--name-only", "HEAD", "runs").splitlines())
    return int(git("rev-list", "--count", "HEAD") or 0), git("rev-parse", "HEAD:state"), runs
