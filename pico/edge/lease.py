"""One mover at a time: a kernel lock in the folder of a bench, which the kernel frees when its holder dies.

Who holds it stands beside the lock, for the message that the second one reads. Tokens count up, for every command to
the bench to carry, so that one that comes late is known for what it is.
"""

from __future__ import annotations

import fcntl
import getpass
import os
import time
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from contextvars import ContextVar
from dataclasses import replace
from pathlib import Path
from typing import Any

from pico.base.clock import now as clock_now
from pico.base.plain_files import open_lock, other_than_file
from pico.base.state_files import ENROLMENT, HOLDER, JOURNAL, LOCK
from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.disk import sweep, writing
from pico.edge.protocol import Granting, Holder, Lease
from pico.edge.stopping import forget
from pico.places import attachment
from pico.places.attachment import require_attached
from pico.places.bench import BenchPlace, hold, let_go
from pico.places.lab import make_own_folder

NAMED_WITHIN = 20
"""Hundredths of a second in which who takes the lock writes its name beside it."""


RETRY = 0.05
"""Seconds between two attempts of who waits for the lock."""


class BenchLock:
    """The lock of the bench at `place`: `lock` in its folder, with the holder in `holder.json`.

    They are those of the worktree that is attached to the bench; only there it can be taken.
    """

    def __init__(self, place: BenchPlace, clock: Callable[[], str] = clock_now) -> None:
        self._place = place
        self._clock = clock
        self._file: int | None = None
        self.server = False
        """Whether this process takes it for others, whom it serves."""
        self.safety = False
        """Whether the bench is taken only to make it safer: that needs nobody's grant."""
        self.granting: Granting | None = None
        """Who grants the bench in place of this lock, where it is enrolled with a coordinator."""

    def acquire(self, holder: str) -> Lease:
        """Take the lock at once or raise PicoError: exit code LOCKED, naming who has it and what for, or which worktree
        the bench is attached to. One that is enrolled with a coordinator only that one grants."""
        require_attached(self._place)
        token = self._granted()
        file = self._open()
        if not self._locked(file):
            os.close(file)
            raise PicoError(self._taken(), ExitCode.LOCKED)
        try:
            require_attached(self._place)  # it may have been taken to another worktree meanwhile
            with self._writing():
                sweep(self._folder)
            hold(self._place)
            forget(self._place)
        except PicoError:
            os.close(file)
            raise
        self._file = file
        lease = Lease(token=token or self._last_token() + 1, holder=holder, since=self._clock())
        try:
            self._write_holder(lease)
        except PicoError:
            self.release()
            raise
        return lease

    def _granted(self) -> int:
        """Return the token that the coordinator of the bench gave; 0 where it has none."""
        if self.granting is not None:
            return self.granting.token()
        if not self.safety and os.path.lexists(ENROLMENT.path(self._folder)):
            raise PicoError(enrolled(self._folder), ExitCode.LOCKED)
        return 0

    def last_token(self) -> int:
        """Return the highest token that was given out by this lock; raises PicoError where it can't be read."""
        file = self._open()
        try:
            return self._last_token(file)
        finally:
            os.close(file)

    @property
    def _folder(self) -> Path:
        return self._place.folder

    def _locked(self, file: int) -> bool:
        """Try to lock; who only asks for the holder has the lock for an instant, too, and does not count."""
        for _ in range(NAMED_WITHIN):
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                who = self._read_holder()
                if who.pid and _alive(who.pid):
                    return False
                time.sleep(0.01)
            else:
                return True
        return False

    async def acquire_within(self, holder: str, seconds: float, given_up: Callable[[], bool]) -> Lease:
        """Take the lock as soon as it is free, at most `seconds` from now; raises PicoError as `acquire` does, and with
        exit code INTERRUPTED once `given_up()` is true."""
        import asyncio

        deadline = time.monotonic() + seconds
        while True:
            if given_up():
                raise PicoError(error("interrupted", "interrupted; nothing has moved"), ExitCode.INTERRUPTED)
            try:
                return self.acquire(holder)
            except PicoError as exc:
                if exc.diagnostics[0].code != "locked" or time.monotonic() >= deadline:
                    raise
            await asyncio.sleep(RETRY)

    def release(self) -> None:
        """Let go of the lock; nothing happens where it is not held."""
        if self._file is not None:
            let_go(self._place)
            with suppress(OSError):  # on a disk that became read-only it stays; it names nobody who lives
                HOLDER.path(self._folder).unlink(missing_ok=True)
            os.close(self._file)
            self._file = None

    @contextmanager
    def held(self, holder: str) -> Iterator[Lease]:
        """Hold the lock for a while; raises PicoError as `acquire` does."""
        lease = self.acquire(holder)
        try:
            yield lease
        finally:
            self.release()

    def _open(self) -> int:
        path = LOCK.path(self._folder)
        with self._writing():
            make_own_folder(self._place.attached.root)
            self._folder.mkdir(parents=True, exist_ok=True)
            if other_than_file(path) or path.is_symlink():
                return LOCK.lock(path)  # which says what it is
            return open_lock(path)

    def _writing(self) -> AbstractContextManager[None]:
        return writing(self._folder, what=f"the bench cannot be locked in {self._folder}", code="lock-file")

    def _last_token(self, file: int | None = None) -> int:
        """Return the highest token given out; kept in the lock's own file, which only its holder writes. Where somebody
        deleted that since the bench was used, or it is damaged, the clock's seconds: more than were ever counted."""
        file = self._file if file is None else file
        assert file is not None
        digits, _, check = os.pread(file, 64, 0).partition(b"\n")
        if digits.strip().isdigit() and check.strip() in (b"", _check(digits)):
            return int(digits)
        return int(time.time()) if digits or JOURNAL.path(self._folder).exists() else 0

    def _write_holder(self, lease: Lease) -> None:
        assert self._file is not None
        with self._writing():
            digits = b"%-31d" % lease.token
            os.pwrite(self._file, digits + b"\n" + _check(digits) + b"\n", 0)
            os.fsync(self._file)
        who = {
            "token": lease.token, "user": user(), "pid": os.getpid(), "since": lease.since, "what": lease.holder,
            "server": self.server,
        }  # fmt: skip
        with suppress(PicoError):  # it is for who asks; the lock is taken
            HOLDER.write(HOLDER.path(self._folder), who, durable=False)

    def holder(self) -> Holder | None:
        """Return who has the lock, or None where nobody has it; takes it for no longer than the question needs."""
        try:
            file = open_lock(LOCK.path(self._folder), make=False)
        except OSError:
            return None
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return self._read_holder()
        finally:
            os.close(file)
        return None

    def _read_holder(self) -> Holder:
        nobody = Holder(token=0, user="somebody", pid=0, since="", what="another process")
        return HOLDER.read(HOLDER.path(self._folder), _holder) or nobody

    def _taken(self) -> Diagnostic:
        who = self._read_holder()
        for _ in range(NAMED_WITHIN):
            if who.pid and _alive(who.pid):
                break
            time.sleep(0.01)  # it has just taken the lock, and its name is not there yet
            who = self._read_holder()
        return _in_use(who)


def _holder(who: Mapping[str, Any]) -> Holder:
    return Holder(
        token=int(who["token"]), user=str(who["user"]), pid=int(who["pid"]), since=str(who["since"]),
        what=str(who["what"]), server=bool(who.get("server")),
    )  # fmt: skip


async def wait_until_free(holder: Callable[[], Holder | None], seconds: float) -> None:
    """Wait until nobody has a bench, as `holder` says, at most so long; raises PicoError (exit code LOCKED), naming who
    has."""
    import asyncio

    deadline = time.monotonic() + seconds
    while (who := await asyncio.to_thread(holder)) is not None:
        if time.monotonic() >= deadline:
            raise PicoError(_in_use(who, f"it was waited for {seconds:g} s"), ExitCode.LOCKED)
        await asyncio.sleep(RETRY)


def _check(digits: bytes) -> bytes:
    """Return the checksum that stands behind a token; an earlier PICO wrote none."""
    return b"%08x" % zlib.crc32(digits)


def attach(place: BenchPlace) -> Path | None:
    """Attach the worktree of a lab to its bench, and return the lab's folder that had it, None for none.

    Raises PicoError, exit code LOCKED, where somebody moves the bench.
    """
    elsewhere = place.folder != place.own
    with BenchLock(place.attached).held("pico git attach") if elsewhere else nullcontext():
        return attachment.attach(place)


def enrolled(folder: Path) -> Diagnostic:
    """Return that a bench is granted by its coordinator alone."""
    try:
        where = ENROLMENT.read(ENROLMENT.path(folder), lambda note: f"{note['bench']} at {note['url']}")
    except PicoError as exc:  # a bench whose enrolment is damaged stays enrolled
        found = exc.diagnostics[0]
        return replace(
            found, code="enrolled", summary=f"the bench counts as enrolled with a coordinator: {found.summary}"
        )
    where = where or "a coordinator"
    text = f"this bench is enrolled as {where}, which alone grants it"
    hint = "go through it (`pico remote add`, then `--bench`); looking is possible here, and so is `pico stop`"
    return error("enrolled", text, hint=hint)


def _in_use(who: Holder, more: str = "") -> Diagnostic:
    hint = "wait with `--lock-timeout SECONDS`, or end it with `pico stop`; looking is always possible"
    return error("locked", f"the bench is in use by {who.said}{'; ' if more else ''}{more}", hint=hint)


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


_FOR: ContextVar[str] = ContextVar("for", default="")


@contextmanager
def on_behalf_of(who: str) -> Iterator[None]:
    """Do something, and begin every task that it starts, for somebody who is known to a coordinator by that name."""
    before = _FOR.set(who)
    try:
        yield
    finally:
        with suppress(ValueError):  # what answers was left, and is closed where nobody is there any more
            _FOR.reset(before)


def from_afar() -> str:
    """Return for whom of a coordinator something is done; empty where it is for nobody there."""
    return _FOR.get() or ""


def user() -> str:
    """Return the name of whom something is done for: the user of this process, or the number where it has no name, if
    it is not for somebody else (`on_behalf_of`)."""
    if who := _FOR.get():
        return who
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return str(os.getuid())
