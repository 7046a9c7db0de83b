"""Git's `index.lock`, taken by PICO in such a way that one left by a killed `pico commit` is known for what it is.

The lock is a hard link to a file of PICO's own (the claim), whose kernel lock the process and the git commands that it
starts hold: it is ours if both are one file, and nobody is alive who has it if that kernel lock is free. A lock of
anybody else's is named and left.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from pico.diagnostics import PicoError
from pico.disk import unwritable
from pico.history.git.holders import git_processes, held
from pico.history.writing.claim import Claim, GitFolders, give_up
from pico.history.writing.guard import guarded

WAIT = 10.0
"""Seconds that somebody else's lock is waited for; git holds one for milliseconds, unless an editor is open."""
ALONE = 2.0
"""Seconds that it is waited for where no git command is seen running."""
_RETRY = 0.02


@contextmanager
def index_lock(at: GitFolders, doing: str, base: str | None, refs: Sequence[Path]) -> Iterator[Claim]:
    """Hold the lock of the index; yields the claim, whose open file the git commands that are started must inherit.

    Call it under the lock of writers, after `recover`. `doing`: the command; `base`: the commit at HEAD; `refs`: the
    files of the refs that are about to move. While the claim is `pending` at the end, lock and claim stay, for the
    guard or the next command. Raises PicoError where somebody else holds the lock for longer than WAIT.
    """
    claim = _claimed(at, doing, base, refs)
    linked = True
    try:
        with guarded(at.claim, at.root):
            try:
                linked = take(at)
                yield claim
            finally:
                if not claim.pending:
                    release(at, linked=linked)
    finally:
        os.close(claim.file)


def _claimed(at: GitFolders, doing: str, base: str | None, refs: Sequence[Path]) -> Claim:
    """Make the claim, which says what it is about to change, and lock it."""
    return Claim.make(at, doing, base, refs)


def release(at: GitFolders, *, linked: bool = True) -> None:
    """Give lock and claim up."""
    if not linked or taken(at):
        at.lock.unlink(missing_ok=True)
    give_up(at)


def take(at: GitFolders) -> bool:
    """Take git's lock as a hard link of the claim; return False where the file system has none, and it is a file like
    git's own. Raises PicoError that names somebody else's, after WAIT seconds."""
    if taken(at):
        return True
    start, patience = time.monotonic(), min(WAIT, ALONE)
    while True:
        with suppress(FileExistsError):
            try:
                os.link(at.claim, at.lock)
                return True
            except FileExistsError:
                raise
            except OSError:
                _make(at.lock)
                return False
        if time.monotonic() >= start + patience:
            if patience == WAIT or not git_processes(at.root):
                raise PicoError(held(at.lock, at.root, patience))
            patience = WAIT
        time.sleep(_RETRY)


def _make(lock: Path) -> None:
    try:
        os.close(os.open(lock, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    except FileExistsError:
        raise
    except OSError as exc:
        raise PicoError(unwritable(lock, exc, code="folder")) from exc


def taken(at: GitFolders) -> bool:
    """Whether git's lock is that of the claim."""
    try:
        return at.claim.samefile(at.lock)
    except OSError:
        return False
