"""The lock of a person at the table: while it is there, remote, queued and unattended work on the bench is refused. It
outlives every process and reboot, and only that person takes it off, at this machine. It keeps nobody from stopping the
bench or from ending light."""

from __future__ import annotations

from pico.base import clock
from pico.base.state_files import TABLE_LOCK
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.edge.lease import from_afar
from pico.model.record import as_json, record
from pico.places.bench import BenchPlace

CODE = "table-lock"
"""The code of all that is said of the lock."""


@record
class TableLock:
    """Who locked the bench (Git's `user.name`), since when (ISO 8601, UTC), and why."""

    schema: str = TABLE_LOCK.schema
    by: str
    since: str
    reason: str = ""

    @property
    def said(self) -> str:
        """Who locked the bench, since when and why, in words."""
        return f"{self.by} locked the bench at the table at {self.since}{f': {self.reason}' if self.reason else ''}"


def read(place: BenchPlace) -> TableLock | None:
    """Return the lock of a bench, None if it is not locked; raises PicoError for a lock that can't be read."""
    return TABLE_LOCK.read(TABLE_LOCK.path(place.folder), lambda note: TableLock(**note))


def lock(place: BenchPlace, by: str, reason: str) -> TableLock:
    """Lock a bench for the person `by`, durably; a lock that is there stays, but one that can't be read. Raises
    PicoError (exit code LOCKED) if another person has it."""
    try:
        found = read(place)
    except PicoError:  # what can't be read locks the bench for nobody in particular: it is replaced
        found = None
    if found is not None and found.by != by:
        raise PicoError(_of_another(found), ExitCode.LOCKED)
    made = TableLock(
        by=by, since=found.since if found else clock.now(), reason=reason or (found.reason if found else "")
    )
    TABLE_LOCK.write(TABLE_LOCK.path(place.folder), as_json(made), what="the bench can't be locked")
    return made


def unlock(place: BenchPlace, by: str) -> TableLock | None:
    """Take the lock off that the person `by` put on, and return it; None if there was none. Raises PicoError (exit code
    LOCKED) if another person has it."""
    found = read(place)
    if found is None:
        return None
    if found.by != by:
        raise PicoError(_of_another(found), ExitCode.LOCKED)
    TABLE_LOCK.path(place.folder).unlink(missing_ok=True)
    return found


def refusal(place: BenchPlace, *, alone: bool) -> Diagnostic | None:
    """Return why work is refused now, None if it is not: it is for somebody at a coordinator, or nobody attends it
    (`alone`), and a person at the table locked the bench. Raises PicoError for a lock that can't be read."""
    if not (alone or from_afar()) or (found := read(place)) is None:
        return None
    what = "unattended work" if alone else "remote work"
    hint = (
        f"{found.by} takes the lock off at the table, with `pico lease unlock`; stopping and ending light stay possible"
    )
    return error(CODE, f"{found.said}; {what} is refused until then", hint=hint)


def require(place: BenchPlace, *, alone: bool = False) -> None:
    """Raise PicoError (exit code LOCKED) if work is refused now, see `refusal`."""
    if (wrong := refusal(place, alone=alone)) is not None:
        raise PicoError(wrong, ExitCode.LOCKED)


def notice(place: BenchPlace) -> tuple[Diagnostic, ...]:
    """Return what everybody is told who looks at a locked bench."""
    try:
        found = read(place)
    except PicoError as exc:
        return tuple(exc.diagnostics)
    hint = "remote and unattended work is refused; `pico lease unlock` at the table takes the lock off"
    return (warning(CODE, found.said, hint=hint),) if found is not None else ()


def _of_another(found: TableLock) -> Diagnostic:
    hint = f"only {found.by} takes it off, with `pico lease unlock` here"
    return error(CODE, found.said, hint=hint)
