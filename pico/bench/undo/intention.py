"""What somebody called last on a bench and approved, kept from the approval to the end of the command.

A command that is killed while it looks or plans leaves no run. Its intention stays on the disk, and `status`, `undo`
and `resume` say so. The file is locked as long as the command lives; if it is killed, the kernel lets go of the lock.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from pico.base import clock
from pico.base.plain_files import open_file, set_aside
from pico.base.state_files import CALLED
from pico.diagnostics import Diagnostic, PicoError, warning
from pico.edge.lease import user
from pico.edge.network.opening import remembered
from pico.model.record import as_json, record

if TYPE_CHECKING:
    from pico.edge.network.remotes import Place

CODE = "cut-short"
"""The code of what is said of a command or a run that was killed or interrupted."""
EARLY = "before it moved anything"
"""How a command or a run was killed of which nothing has to be taken back."""


@record
class Intention:
    """A command that was approved. `at`: when (the wall, ISO 8601, UTC); `operator`: by whom; `last`: the number of
    the run that had moved something last by then."""

    command: str
    at: str
    operator: str = ""
    last: int = 0


def keep(place: Place, command: str) -> Callable[[], None]:
    """Write that a command was approved, and return what to call at its end. A disk that is full, or a folder that
    can't be written to, keeps no command from running."""
    path = _path(place)
    found = Intention(command=command, at=clock.now(), operator=user(), last=_last(place) or 0)
    try:
        set_aside(path)
        file = os.fdopen(open_file(path, os.O_RDWR | os.O_CREAT | os.O_APPEND), "ab+")  # no folder: nothing to undo
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:  # another command is at it, which says so itself, or nothing can be written
        return lambda: None

    def end() -> None:
        with suppress(OSError):
            path.unlink()
        with suppress(OSError):
            file.close()

    try:
        file.truncate(0)
        file.write(CALLED.dump(as_json(found)))
        file.flush()
        os.fsync(file.fileno())
    except OSError:  # a full disk: no half of it stays
        end()
        return lambda: None
    return end


def killed(place: Place) -> Intention | None:
    """Return the command that was approved last, if it was killed before any run of it began to move something."""
    path = _path(place)
    try:
        with os.fdopen(open_file(path, os.O_RDONLY), "rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
            found = CALLED.made(path, file.read(), lambda document: Intention(**document))
    except (OSError, PicoError):
        return None  # none, one that goes on, or one that was killed while it was written
    last = _last(place)
    return found if last is not None and last <= found.last else None


def told(place: Place) -> tuple[Diagnostic, ...]:
    """Return that what was called last was killed before it moved anything."""
    found = killed(place)
    if found is None:
        return ()
    return (warning(CODE, _text(found), hint=f"`pico {found.command}` does it; nothing has changed"),)


def require_named(place: Place, command: str, run: str) -> None:
    """Raise PicoError if what was called last was killed before it moved anything: `command` without a run, and without
    a question, would then be about the run before it, `run`."""
    from pico.diagnostics import error

    if (found := killed(place)) is not None:
        raise PicoError(error(CODE, f"{_text(found)}; `pico {command}` would be about {run}",
                              hint=f"`pico {command} {run.split()[1]}` says that this is meant"))  # fmt: skip


def _text(found: Intention) -> str:
    when = f"{found.at[:16].replace('T', ' ')} UTC"
    return f"what was called last (`pico {found.command}`, {when}) was killed {EARLY}"


def _path(place: Place) -> Path:
    return CALLED.path(place.folder)


def _last(place: Place) -> int | None:
    """Return the number of the run that began last to move something, 0 for none; None if the journal can't be read."""
    try:
        with remembered(place) as memory:
            moving = memory.moving() if memory else frozenset()
            return max((run.number for run in memory.runs() if run.run in moving), default=0) if memory else 0
    except PicoError:  # reported by whoever needs the journal
        return None
