"""Damaged rows of a journal: how they are noticed, what they are called, and what the commits of the lab hold of them.

Each row has a checksum of its own (CRC-32, which finds every flipped bit), a run one for each of its four parts. A row
from before version 4 of the journal has none; it counts as sound if its JSON can be read.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from pico.base.plain_files import read_text
from pico.base.state_files import JOURNAL, RUN_MARK
from pico.diagnostics import Diagnostic, PicoError, error

CARRYING = "pico.history.runs.carrying"
"""Looks runs up in commits. By name, for history stands above journals; it is asked only if something is damaged."""
PARTS = ("head", "document", "about", "seen")
"""What a run has a checksum for: its columns that are short, its plan, how it began, and how the bench was seen."""
PHASES: Mapping[str, int] = {"intent": 0, "started": 1, "done": 2, "failed": 2, "unknown": 2, "resolved": 3}
SALVAGE = "`pico doctor --journal` says what can be salvaged and what would be lost; it changes nothing without --yes"


def checksum(*values: object) -> str:
    """Return the checksum of some columns of a row, as hexadecimal digits."""
    text = "\x1f".join("" if value is None else str(value) for value in values)
    return f"{zlib.crc32(text.encode('utf-8', 'surrogateescape')):08x}"


def sums_of_run(row: Sequence[Any]) -> str:
    """Return the checksums of a run's row: number, run, plan, holder, started_at, finished_at, outcome, tally, resumed,
    document, about, seen."""
    return " ".join((checksum(*row[:9]), *(checksum(one) for one in row[9:12])))


def is_sound_part(value: object, sums: object, part: str) -> bool:
    """Return whether a part of a run (JSON, or None) is as it was written."""
    if isinstance(sums, str):
        known = sums.split(" ")
        return len(known) == len(PARTS) and known[PARTS.index(part)] == checksum(value)
    return value is None or _is_json(value)


def is_sound_head(row: Sequence[Any], sums: object) -> bool:
    """Return whether the short columns of a run are as they were written."""
    number, run, _, _, started, _, outcome, tally, resumed = row
    if isinstance(sums, str):
        return sums.split(" ")[0] == checksum(*row)
    texts = isinstance(number, int) and isinstance(run, str) and isinstance(started, str)
    known = outcome in (None, "done", "failed", "interrupted")
    return texts and known and (resumed is None or isinstance(resumed, int)) and (tally is None or _is_json(tally))


def is_sound_record(row: Sequence[Any]) -> bool:
    """Return whether a record is as it was written: seq, key, run, phase, kind, component, digest, token, at, data, and
    its checksum."""
    *columns, known = row
    if isinstance(known, str):
        return known == checksum(*columns[1:])
    _, key, run, phase, kind, component, *_, data = columns
    shaped = isinstance(key, str) and key.count("/") == 2 and key.startswith(f"{run}/") and isinstance(component, str)
    return shaped and isinstance(kind, str) and PHASES.get(kind) == phase and _is_json(data)


def _is_json(text: object) -> bool:
    try:
        json.loads(text)  # type: ignore[arg-type]
    except (ValueError, TypeError, RecursionError):
        return False
    return True


def damaged_row(path: Path, what: str) -> Diagnostic:
    """Return that a row of the journal at `path` is damaged, and in no commit."""
    text = f"{what} in the journal of the bench {path.parent.name} is damaged, and no commit has that run: {path}"
    return error("journal-record", text, hint=SALVAGE)


def marked_run(path: Path) -> str:
    """Return the run that has begun and not ended by the mark beside the journal at `path`, empty for none. The mark is
    written once the journal has the run."""
    if path.name == JOURNAL.name:  # and not a copy
        with suppress(OSError, UnicodeError):
            return read_text(RUN_MARK.path(path.parent), "ascii").strip()
    return ""


def lost_end(path: Path, why: str) -> Diagnostic:
    """Return that the journal at `path` has lost what was written to it last."""
    text = f"the journal of the bench {path.parent.name} has lost what was written last: {why}: {path}"
    return error("journal-record", text, hint=SALVAGE)


@dataclass(frozen=True)
class FromCommit:
    """What commits hold of a run: the columns of its row (`head`, `about`, `seen`; its plan they do not hold), and its
    records as (key, kind, component, at, data)."""

    head: tuple[Any, ...]
    about: tuple[Mapping[str, Any], ...]
    seen: Mapping[str, Any] | None
    records: tuple[tuple[str, str, str, str, Mapping[str, Any]], ...]


def from_commit(path: Path, run: str) -> FromCommit | None:
    """Return what the commits of a lab hold of a run of the journal at `path`; None if no commit has it."""
    if len(path.parents) < 4 or path.parents[2].name != ".pico":
        return None
    try:
        found: FromCommit | None = import_module(CARRYING).carried(path.parents[3], run)
    except PicoError:  # without manifests or a repository that can be read there are no commits
        return None
    return found
