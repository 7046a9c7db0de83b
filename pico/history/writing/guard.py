"""Who clears up at once after a PICO that was killed while it had git's lock of the index.

A process in a session of its own waits for the kernel's lock of the claim, which is free when PICO and all git commands
that it started are dead. Then it does what the next `pico` command would do, so that plain git is not kept waiting for
that one. If it is killed, too, the next `pico` command does it.
"""

from __future__ import annotations

import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

_WAITING = """\
import fcntl, os, sys
try:
    claim = os.open(sys.argv[1], os.O_RDWR)
except OSError:
    sys.exit()
fcntl.flock(claim, fcntl.LOCK_EX)
if os.fstat(claim).st_nlink:
    os.execv(sys.executable, [sys.executable, "-P", "-m", "pico.history.repository.clear_up", sys.argv[2]])
"""


@contextmanager
def guarded(claim: Path, root: Path) -> Iterator[None]:
    """Let a claim in the working tree `root` be watched; who still has it at the end leaves it to the guard."""
    words = [sys.executable, "-I", "-S", "-c", _WAITING, str(claim), str(root)]
    quiet = subprocess.DEVNULL
    try:
        guard = subprocess.Popen(words, cwd=root, stdin=quiet, stdout=quiet, stderr=quiet, start_new_session=True)
    except OSError:  # no room for a process more: then it is the next command that clears up
        yield
        return
    try:
        yield
    finally:
        if not claim.exists():
            guard.kill()
            guard.wait()
