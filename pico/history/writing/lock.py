"""One writer at a time: who splices manifests and commits holds a kernel lock, shared by all worktrees.

The kernel frees it when its holder dies. Who has it stands in the file, for the message that a second one reads.
"""

from __future__ import annotations

import fcntl
import getpass
import json
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pico.base.state_files import GIT_LOCK
from pico.diagnostics import PicoError, error

WAIT = 60.0
"""Seconds that a writer waits for another one: as long as somebody's pre-commit hooks may take."""
_RETRY = 0.01


@contextmanager
def write_lock(path: Path, doing: str, seconds: float = WAIT) -> Iterator[None]:
    """Hold the lock `path` while `doing` something; waits for it at most so long.

    Raises PicoError that names the holder, or says that the lock can't be made.
    """
    file = _open(path)
    try:
        deadline = time.monotonic() + seconds
        while not _locked(file):
            if time.monotonic() >= deadline:
                hint = "wait for it, or look at what it does: an editor or a hook may be waiting for somebody"
                text = f"{_holder(file)} is writing manifests or a commit here; it was waited for {seconds:g} s"
                raise PicoError(error("write-locked", text, hint=hint))
            time.sleep(_RETRY)
        _sign(file, doing)
        yield
    finally:
        os.close(file)


def _open(path: Path) -> int:
    return GIT_LOCK.lock(path)


def _locked(file: int) -> bool:
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _sign(file: int, doing: str) -> None:
    who = json.dumps({"user": _user(), "pid": os.getpid(), "what": doing}).encode()
    with suppress(OSError):  # on a full disk nobody learns who it is
        os.ftruncate(file, 0)
        os.pwrite(file, who, 0)


def _holder(file: int) -> str:
    try:
        who = json.loads(os.pread(file, 4096, 0))
        return f"{who['user']} (process {who['pid']}: {who['what']})"
    except (ValueError, KeyError, TypeError):
        return "another process"


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return str(os.getuid())
