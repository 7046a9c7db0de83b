"""The record of which worktree of a repository has which bench of a lab.

It is `pico/bench.json` of the folder that all worktrees of a repository share: the lab's folder in the repository, and
below it each bench with the folder, relative to Git's, of the lab in the worktree that is attached to it.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from copy import deepcopy
from pathlib import Path

from pico.base.state_files import RECORD, RECORD_LOCK
from pico.diagnostics import PicoError
from pico.places.lab import BENCHES, FOLDER, LabPlace, is_lenient, lab_place

SHARED = ""
"""The name below which a record that an earlier PICO wrote stands: all benches of a lab were in one folder then."""
Record = dict[str, dict[str, str]]


def attached(place: LabPlace, name: str) -> Path | None:
    """Return the folder of the lab in the worktree that has the bench `name`; None if no worktree there has it."""
    there = recorded(place, read_record(place), name)
    return there if there is not None and is_of(there, place) else None


def recorded(place: LabPlace, record: Mapping[str, Mapping[str, str]], name: str) -> Path | None:
    """Return which folder the record names for the bench `name`; if it names none, that of the main worktree if it has
    used the bench already."""
    known = record.get(place.inside, {})
    if (there := known.get(name, known.get(SHARED))) is not None:
        return Path(os.path.normpath(place.common / there))
    main = place.common.parent / place.inside
    used = place.common.name == ".git" and (main / FOLDER / BENCHES / name / "lock").exists()
    return main if used else None


def is_of(folder: Path, place: LabPlace) -> bool:
    """Return whether a folder still is this lab in a worktree of the same repository. Raises PicoError if its `.git`
    cannot be read: it may have the bench."""
    found = lab_place(folder) if folder.is_dir() else None
    return found is not None and (found.common, found.inside) == (place.common, place.inside)


def worktrees(place: LabPlace) -> tuple[Path, ...]:
    """Return the folders of the lab in the worktrees of its repository that are there now, the main one first."""
    tops = [place.common.parent] if place.common.name == ".git" else []
    for link in sorted(place.common.glob("worktrees/*/gitdir")):
        with suppress(OSError):
            mark = link.read_text(encoding="utf-8", errors="surrogateescape").strip()
            tops.append(Path(os.path.realpath(link.parent / mark)).parent)
    return tuple(top / place.inside for top in tops if (top / place.inside).is_dir())


def note(place: LabPlace, record: Record, name: str) -> None:
    """Let a record say that the worktree of `place` has the bench `name`."""
    record.setdefault(place.inside, {})[name] = os.path.relpath(place.root, place.common)


@contextmanager
def recording(place: LabPlace) -> Iterator[Record]:
    """Read the record, and write it if it was changed; no other process does so meanwhile. Raises PicoError."""
    path = place.record
    try:
        lock = RECORD_LOCK.lock(path.with_suffix(".lock"))
        if is_lenient():
            _read(place)
    except PicoError:
        if not is_lenient():
            raise
        yield deepcopy(read_record(place))
        return
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        record = read_record(place)
        before = deepcopy(record)
        yield record
        if record != before:
            RECORD.write(path, record, indent=2)
    finally:
        os.close(lock)


def read_record(place: LabPlace) -> Record:
    """Return the record, one of an earlier PICO lifted. Raises PicoError for one that can't be read."""
    try:
        return _read(place)
    except PicoError:
        if not is_lenient():
            raise
        return {}


def _read(place: LabPlace) -> Record:
    return RECORD.read(place.record, _record) or {}


def _record(document: Mapping[str, object]) -> Record:
    return {inside: _lifted(benches) for inside, benches in document.items()}


def _lifted(benches: object) -> dict[str, str]:
    if isinstance(benches, str):
        return {SHARED: benches}
    if not isinstance(benches, dict):
        return {}
    return {str(name): there for name, there in benches.items() if isinstance(there, str)}
