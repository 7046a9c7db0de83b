"""The terms of the last unattended run of a bench, in three places: losing one of them must not leave the light on.

`unattended.json` holds them until the run has left the bench as it states. The lock of the process that holds the run
to them has them, too, and is emptied at that end. The journal has them with the run that has begun and not ended.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Mapping
from contextlib import closing, suppress
from typing import Any

from pico.base.plain_files import open_lock, read_file, remove_file
from pico.base.state_files import JOURNAL, RUN_MARK, UNATTENDED, UNATTENDED_LOCK
from pico.diagnostics import Diagnostic, PicoError, error
from pico.model.record import as_json
from pico.model.trace.unattended import LAMPS_OFF, SHUT, Terms
from pico.places.bench import BenchPlace

ABOUT = "unattended"
"""Below what the journal has the terms in what it holds about a run."""


def read(place: BenchPlace) -> Terms | None:
    """Return the terms of the last unattended run that the bench knows; None if there was none.

    Of a file that is damaged they are unknown: a run then counts as killed that has to leave every laser shut and every
    lamp off, and whoever takes the bench next does so and writes the file anew. If the file is gone, and its run was
    not left as it states, they are those of the lock, or of the journal.
    """
    path = UNATTENDED.path(place.folder)
    try:
        return UNATTENDED.read(path, _terms) or _of_lock(place) or _of_journal(place)
    except PicoError as exc:
        return _unknown(exc.diagnostics[0].summary)


def missing(place: BenchPlace) -> Diagnostic | None:
    """Return that the terms of a run that was killed are gone from their file; None if they are not."""
    path = UNATTENDED.path(place.folder)
    if os.path.lexists(path) or alive(place) or (terms := read(place)) is None:
        return None
    run = terms.recipe.partition("@")[0]
    text = f"{path} is gone, and the unattended run {run} has not left the bench as it states"
    return error("unattended", text, hint="`pico recover` leaves it so: lasers shut, lamps off")


def restore(place: BenchPlace) -> None:
    """Write the terms of a run that was killed anew if their file is gone, before the journal ends that run. Raises
    PicoError."""
    if is_known(place) and not os.path.lexists(UNATTENDED.path(place.folder)) and (terms := read(place)) is not None:
        write(place, terms)


def is_known(place: BenchPlace) -> bool:
    """Return whether any of the files is there that may know of an unattended run."""
    return any(os.path.lexists(file.path(place.folder)) for file in (UNATTENDED, UNATTENDED_LOCK, RUN_MARK))


def write(place: BenchPlace, terms: Terms) -> None:
    """Keep the terms of a run; raises PicoError."""
    UNATTENDED.write(UNATTENDED.path(place.folder), as_json(terms), indent=1)


def erase(place: BenchPlace) -> None:
    """Keep no terms any more: the run was left as it states. Raises OSError."""
    remove_file(UNATTENDED.path(place.folder))


def alive(place: BenchPlace) -> bool:
    """Return whether a process holds a run of this bench to its terms."""
    try:
        file = open_lock(UNATTENDED_LOCK.path(place.folder), make=False)
    except OSError:
        return False
    try:
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return False
    except BlockingIOError:
        return True
    finally:
        os.close(file)


def lock(place: BenchPlace) -> int | None:
    """Return the lock of who holds a run to its terms, taken; None if another process has it. Raises PicoError."""
    path = UNATTENDED_LOCK.path(place.folder)
    file = UNATTENDED_LOCK.lock(path)
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(file)
        return None
    return file


def mark(file: int, terms: Terms | None) -> None:
    """Write terms into a lock, None to empty it. A disk that refuses leaves what was there."""
    with suppress(OSError):
        data = b"" if terms is None else UNATTENDED.dump(as_json(terms))
        os.pwrite(file, data, 0)
        os.ftruncate(file, len(data))
        os.fsync(file)


def _of_lock(place: BenchPlace) -> Terms | None:
    path = UNATTENDED_LOCK.path(place.folder)
    try:
        data = read_file(path)
    except OSError:
        return None
    return UNATTENDED.made(path, data, _terms) if data else None


def _of_journal(place: BenchPlace) -> Terms | None:
    """Return the terms of the last run if that was killed; a journal that can't be read is reported by who needs it."""
    if not RUN_MARK.path(place.folder).exists():
        return None
    from pico.runs.journal import Journal

    with suppress(PicoError), closing(Journal(JOURNAL.path(place.folder), looking=True)) as journal:
        last = journal.last()
        if last is not None and last.finished_at is None:
            for about in reversed(journal.about(last.run)[0]):
                return _terms(about[ABOUT]) if ABOUT in about else None
    return None


def _unknown(why: str) -> Terms:
    text = f"an unattended run whose terms are damaged ({why})"
    return Terms(recipe=text, laser_class="1", until="", every=0.0, end=(SHUT, LAMPS_OFF))


def _terms(document: Mapping[str, Any]) -> Terms:
    from pydantic import TypeAdapter

    found: Terms = TypeAdapter(Terms).validate_python(document)
    return found
