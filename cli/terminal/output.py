"""Where text goes: standard output and standard error, also once nobody reads them any more."""

from __future__ import annotations

import errno
import os
import shutil
import stat
import sys
from typing import TextIO

from ..hints import with_flags
from ..views.style import folded, inert, plain

GONE = (errno.EPIPE, errno.EIO)
"""Writing fails so where nobody reads any more: a pipe was closed, or a terminal."""

unsaid: list[OSError] = []
"""Why standard output took no more, where readers were not the matter but a disk: the command ends with an error."""

flags: list[str] = []
"""The flags that reach the bench of this command, for the commands that it prints; see `hints`."""


def colored(stream: TextIO) -> bool:
    """Return whether color helps: on a terminal or in its pager, unless NO_COLOR (no-color.org) or TERM=dumb say no."""
    shown = stream.isatty() or (stream is sys.stdout and "GIT_PAGER_IN_USE" in os.environ)
    return shown and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def write(stream: TextIO, text: str, end: str = "\n", *, over: bool = False, data: bool = False) -> bool:
    """Write; where nobody reads any more (`pico log | head`), go on in silence, for the work must end properly.

    Commands in it get the flags that reach this bench, unless it is `data`. What would steer a terminal is written out
    (`views.style.inert`), and no word is broken at its edge. `over`: over the line where the cursor is. Return whether
    somebody may still read.
    """
    text = text if data else with_flags(text, flags)
    safe = inert(text if colored(stream) else plain(text))
    if stream.isatty() and not over:
        safe = folded(safe, shutil.get_terminal_size().columns)
    try:
        stream.write(f"\r{safe}\x1b[K{end}" if over else f"{safe}{end}")
        stream.flush()
    except OSError as exc:
        if stream is sys.stdout and (exc.errno not in GONE or _into_file(stream)):
            unsaid.append(exc)
        silence(stream)
        return False
    return True


def _into_file(stream: TextIO) -> bool:
    return stat.S_ISREG(os.fstat(stream.fileno()).st_mode)


def silence(stream: TextIO) -> None:
    """Send what is written to `stream` from now on nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
