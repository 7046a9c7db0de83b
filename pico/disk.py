"""Files that are written whole or not at all, and what is said where a disk is full, fails or may not be written."""

from __future__ import annotations

import errno
import glob
import os
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, cast

from pico.diagnostics import Diagnostic, PicoError, error

_WORDS = {
    errno.ENOSPC: ("no space left on the disk mounted at {}", "make room there (`df -h {}`), then call it again"),
    errno.EDQUOT: ("no space left in your quota on the disk mounted at {}", "make room there, then call it again"),
    errno.EROFS: ("the disk mounted at {} is read-only", "mount it writable, or work in a clone elsewhere"),
    errno.EIO: (
        "input/output error of the disk mounted at {}",
        "the disk fails, `dmesg` may say how: copy what matters elsewhere, then call it again",
    ),
}
LEAST = 1 << 20
"""Bytes that a command needs on the disk for what it writes beside data."""
_SPOKEN = {
    errno.ENOSPC: r"no space left on device|database or disk is full",
    errno.EDQUOT: r"(disk )?quota exceeded",
    errno.EROFS: r"read-only file ?system|readonly database",
    errno.EIO: r"input/output error|disk I/O error",
}


def write_whole(
    path: Path, data: bytes, *, what: str = "", code: str = "unwritable", folders: bool = False, durable: bool = True
) -> None:
    """Write a file: a reader sees the old one or the new one, and no failure leaves anything beside it.

    A link gives way to the file; what is no file (`/dev/stdout`, a pipe) is written straight. `folders`: make those
    that are missing. `durable`: on the disk before it takes the other's place. Raises PicoError: `what` (without it,
    "can't write PATH"), which disk, and why.
    """
    with writing(path, what=what, code=code):
        if _is_stream(path):
            path.write_bytes(data)
            return
        if folders:
            path.parent.mkdir(parents=True, exist_ok=True)
        sweep(path.parent, glob.escape(path.name))
        replace_whole(path, (data,), beside(path), durable=durable)


def write_all(files: Mapping[Path, bytes]) -> None:
    """Write files that belong together: all are on their disks before the first takes its place. Raises PicoError."""
    with ExitStack() as fresh:
        for path, data in files.items():
            with writing(path):
                sweep(path.parent, glob.escape(path.name))
                fresh.enter_context(removed(beside(path)))
                _fill(beside(path), (data,), path)
        for path in files:
            with writing(path):
                beside(path).replace(path)


def beside(path: Path) -> Path:
    """Return where this process writes a file first that is to take the place of `path`."""
    return path.with_name(f".{path.name}.{os.getpid()}.tmp")


def _is_stream(path: Path) -> bool:
    place = path.absolute()
    named = place.parts[1:2] in (("dev",), ("proc",)) and not place.is_relative_to("/dev/shm")  # which is a disk
    return named or (path.exists() and not path.is_file())


def sweep(folder: Path, name: str = "*") -> None:
    """Clear what processes left in a folder beside files (of a name) that were killed, or whose disk did not let go of
    it. Raises OSError."""
    for old in folder.glob(f".{name}.*.tmp*"):
        if (number := old.name.rpartition(".tmp")[0].rpartition(".")[2]).isdigit() and not _alive(int(number)):
            old.unlink(missing_ok=True)


def unnamed(data: bytes = b"") -> BinaryIO:
    """Return a file without a name that holds `data`, to be read from its start or written on: nothing is left of it
    whatever happens. In memory, which no disk can refuse, where the system has that."""
    file: BinaryIO
    try:
        file = os.fdopen(os.memfd_create("pico"), "w+b")
    except AttributeError:
        import tempfile

        file = cast(BinaryIO, tempfile.TemporaryFile())  # noqa: SIM115
    file.write(data)
    file.seek(0)
    return file


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


def replace_whole(path: Path, pieces: Iterable[bytes], fresh: Path, *, durable: bool = True) -> None:
    """Put a file in the place of `path`, written as `fresh` on the same disk first, which is gone in any case.

    Raises OSError.
    """
    with removed(fresh):
        _fill(fresh, pieces, path, durable=durable)
        fresh.replace(path)


def _fill(fresh: Path, pieces: Iterable[bytes], path: Path, *, durable: bool = True) -> None:
    """Write a file that is to take the place of `path`, with its mode."""
    fresh.unlink(missing_ok=True)
    with fresh.open("xb") as file:
        file.writelines(pieces)
        file.flush()
        if durable:
            os.fsync(file.fileno())
    if path.exists():
        shutil.copymode(path, fresh)


@contextmanager
def removed(fresh: Path) -> Iterator[None]:
    """See that a temporary file does not outlive a failure, as far as its disk allows."""
    try:
        yield
    except BaseException:
        with suppress(OSError):
            fresh.unlink(missing_ok=True)
        raise


@contextmanager
def writing(path: Path, *, what: str = "", code: str = "unwritable") -> Iterator[None]:
    """Let a disk that refuses to write `path` be a PicoError, as `unwritable` says it."""
    try:
        yield
    except OSError as exc:
        raise PicoError(unwritable(path, exc, what=what, code=code)) from exc


def full_disk(folder: Path) -> tuple[Diagnostic, ...]:
    """Return an error if the disk that holds a folder has no room for what a command writes, else nothing."""
    try:
        room = os.statvfs(folder)
    except OSError:
        return ()
    if room.f_bavail * room.f_frsize >= LEAST:
        return ()
    what = f"PICO can write nothing below {folder}"
    return (unwritable(folder, OSError(errno.ENOSPC, ""), what=what, code="disk-full"),)


@contextmanager
def disk_trouble(folder: Path, what: str) -> Iterator[None]:
    """Let a disk that is full, fails or is read-only be a PicoError, whoever wrote into `folder` (git's library, too):
    `what` was not done. Other errors pass."""
    try:
        yield
    except PicoError:
        raise
    except Exception as exc:
        if (number := number_of(exc)) not in _WORDS:
            raise
        raise PicoError(unwritable(folder, OSError(number, ""), what=f"{what}: {folder}")) from exc


def unwritable(path: Path, exc: Exception, *, what: str = "", code: str = "unwritable") -> Diagnostic:
    """Return what is said where `path` can't be written: what was not done, which disk, why, and what to do.

    `exc`: an OSError, or what a library made of one.
    """
    number = number_of(exc)
    what = what or f"can't write {path}"
    if number not in _WORDS:
        said = exc.strerror if isinstance(exc, OSError) else None
        return error(code, f"{what}: {(said or str(exc)).lower()}")
    why, remedy = (text.format(mount_point(path)) for text in _WORDS[number])
    return error(code, f"{what}: {why}", hint=remedy)


def of_disk(found: Diagnostic) -> bool:
    """Whether something is wrong because a disk is full, fails or may not be written."""
    return " disk mounted at " in found.summary


def number_of(exc: Exception) -> int | None:
    """Return the errno of a failure; from its words where a library (SQLite, libgit2) kept only those."""
    if isinstance(exc, OSError) and exc.errno is not None:
        return exc.errno
    return spoken(str(exc))


def spoken(words: str) -> int | None:
    """Return the errno of a disk that refused, from the words of who tried; None where they speak of something else."""
    return next((n for n, pattern in _SPOKEN.items() if re.search(pattern, words, re.IGNORECASE)), None)


def refusing(folder: Path) -> OSError | None:
    """Return why nothing can be written into a folder now, None where something can: it is tried, for who failed there
    (SQLite, git) does not always say why."""
    probe = folder / f".probe.{os.getpid()}.tmp"
    try:
        replace_whole(probe, (bytes(4096),), probe.with_suffix(".new.tmp"))
        probe.unlink()
    except OSError as exc:
        with suppress(OSError):
            probe.unlink(missing_ok=True)
        return exc
    return None


def mount_point(path: Path) -> Path:
    """Return where the disk is mounted that `path` is on, or would be."""
    with suppress(OSError):
        path = path.resolve()
        while not os.path.ismount(path):
            path = path.parent
    return path
