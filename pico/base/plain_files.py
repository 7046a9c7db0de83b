"""State files are opened only if they are files: a folder, a named pipe or a socket in the place of one is named, and
nothing ever waits for it."""

from __future__ import annotations

import errno
import os
import stat
from itertools import count
from pathlib import Path

_KINDS = (
    (stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a named pipe"), (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"), (stat.S_ISBLK, "a device"), (stat.S_ISLNK, "a symbolic link that leads nowhere"),
)  # fmt: skip


def other_than_file(path: Path) -> str:
    """Return what lies at `path` if that is no file (`a folder`, `a named pipe` ...); empty for a file, for a link to
    one, and for nothing."""
    try:
        return _kind(path.stat().st_mode)
    except FileNotFoundError:
        return _kind(stat.S_IFLNK) if path.is_symlink() else ""
    except OSError as exc:
        return "a symbolic link to itself" if exc.errno == errno.ELOOP else ""


def _kind(mode: int) -> str:
    return next((name for is_kind, name in _KINDS if is_kind(mode)), "")


def open_file(path: Path, flags: int) -> int:
    """Open a file as `os.open` does, without ever waiting for a named pipe. Raises OSError, also for what is no file:
    its words then say what that is."""
    try:
        file = os.open(path, flags | os.O_NONBLOCK | os.O_CLOEXEC, 0o666)
    except OSError as exc:
        what = other_than_file(path) or ("a symbolic link" if exc.errno == errno.ELOOP else "")
        if what:
            raise OSError(errno.EINVAL, f"it is {what}") from exc
        raise
    what = _kind(os.fstat(file).st_mode)
    if not what:
        return file
    os.close(file)
    raise OSError(errno.EINVAL, f"it is {what}")


def read_file(path: Path) -> bytes:
    """Return what a file holds. Raises OSError as `open_file` does."""
    with os.fdopen(open_file(path, os.O_RDONLY), "rb") as file:
        return file.read()


def read_text(path: Path, encoding: str = "utf-8") -> str:
    """Return the text of a file. Raises OSError as `open_file` does, UnicodeError for what is no text."""
    return read_file(path).decode(encoding)


def open_lock(path: Path, *, make: bool = True) -> int:
    """Open the file of a kernel lock, made if it is missing unless `make` is False. Raises OSError as `open_file`
    does, and for a symbolic link."""
    return open_file(path, os.O_RDWR | os.O_NOFOLLOW | (os.O_CREAT if make else 0))


def aside_of(path: Path) -> Path:
    """Return a free name beside `path` for what is set aside: `NAME.damaged`, `NAME.damaged-2` ..."""
    names = (f"{path.name}.damaged{f'-{number}' if number > 1 else ''}" for number in count(1))
    return next(aside for name in names if not os.path.lexists(aside := path.with_name(name)))


def set_aside(path: Path) -> None:
    """Move what lies at `path` aside if that is no file, so that a file can be written there; nothing is deleted.
    Raises OSError."""
    if other_than_file(path):
        path.rename(aside_of(path))


def remove_file(path: Path) -> None:
    """Delete a file, if there is one; what is no file is moved aside. Raises OSError."""
    set_aside(path)
    path.unlink(missing_ok=True)
