"""How many changes a journal has had, in a file of its own beside it: a write-ahead log that lost its end is a valid
one, only shorter, and nothing in the database tells.

The file is written after the change, so it never counts more than the journal had on the disk, or, for what was not
made durable, had in the memory of this machine since it was started.
"""

from __future__ import annotations

import os
import zlib
from contextlib import suppress
from functools import cache
from pathlib import Path

from pico.base.plain_files import open_file, read_text, set_aside
from pico.base.state_files import CHANGE_COUNT, JOURNAL

_BOOT = Path("/proc/sys/kernel/random/boot_id")
LENGTH = 100
"""Bytes of the file."""


class Count:
    """The count in the file at `path` of what another file holds: changes, or lines; None keeps none."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._durable = 0
        self._file: int | None = None

    def least(self) -> int:
        """Return how many the other file holds at least; 0 if the count is missing or damaged."""
        with suppress(OSError, ValueError, UnicodeError):
            if self._path is not None:
                text, _, checksum = read_text(self._path, "ascii").strip().rpartition(" ")
                if int(checksum) == zlib.crc32(text.encode()):
                    durable, written, *boot = text.split(" ")
                    return int(written) if boot == [_booted()] else int(durable)
        return 0

    def note(self, changes: int, *, durable: bool) -> None:
        """Keep how many there are now; a disk that takes nothing keeps what was there."""
        if self._path is None:
            return
        self._durable = changes if durable else self._durable
        text = f"{self._durable} {changes} {_booted()}"
        with suppress(OSError):
            if self._file is not None and not os.fstat(self._file).st_nlink:  # somebody deleted it
                self.close()
            if self._file is None:
                set_aside(self._path)
                self._file = open_file(self._path, os.O_WRONLY | os.O_CREAT | os.O_NOFOLLOW)
            os.pwrite(self._file, f"{text} {zlib.crc32(text.encode())}".ljust(LENGTH).encode(), 0)

    def close(self) -> None:
        """Let go of the file."""
        if self._file is not None:
            os.close(self._file)
            self._file = None


class ChangeCount(Count):
    """The count of changes of the journal at `path`, beside it; none beside a copy under another name."""

    def __init__(self, path: Path) -> None:
        super().__init__(CHANGE_COUNT.path(path.parent) if path.name == JOURNAL.name else None)


@cache
def _booted() -> str:
    """Return what names this start of the machine; `unknown` if the system does not tell."""
    with suppress(OSError, UnicodeError):
        return _BOOT.read_text(encoding="ascii").strip()
    return "unknown"
