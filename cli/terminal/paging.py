"""Long answers in a pager on a terminal, as git shows its own: GIT_PAGER, the user's core.pager, PAGER, or less."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from ..session import Session
from .ending import Ended


@contextmanager
def paged(session: Session) -> Iterator[None]:
    """Send what is printed inside through a pager; nothing happens where there is no terminal, or no pager."""
    command = _pager(session) if sys.stdout.isatty() and not session.json else ""
    if not command:
        yield
        return
    environment = {"LESS": "FRX", "LV": "-c"} | os.environ
    try:
        pager = subprocess.Popen(command, shell=True, stdin=subprocess.PIPE, env=environment)
    except OSError:
        yield
        return
    assert pager.stdin is not None
    terminal, before = os.dup(sys.stdout.fileno()), os.environ.get("GIT_PAGER_IN_USE")
    os.environ["GIT_PAGER_IN_USE"] = "true"  # color, although this is no terminal any more
    os.dup2(pager.stdin.fileno(), sys.stdout.fileno())
    pager.stdin.close()
    try:
        yield
    finally:
        with suppress(BrokenPipeError):
            sys.stdout.flush()
        os.dup2(terminal, sys.stdout.fileno())
        os.close(terminal)
        _wait(pager)
        if before is None:
            del os.environ["GIT_PAGER_IN_USE"]


def _wait(pager: subprocess.Popen[bytes]) -> None:
    """Wait until the reader has done; Ctrl-C is for the pager."""
    while True:
        try:
            pager.wait()
            return
        except Ended:
            pager.terminate()
            raise
        except KeyboardInterrupt:
            continue


def _pager(session: Session) -> str:
    """Return the command of the pager as a shell takes it; empty for none."""
    told = os.environ.get("GIT_PAGER")
    found = _configured(session) or os.environ.get("PAGER", "less") if told is None else told
    return "" if found == "cat" else found


def _configured(session: Session) -> str:
    """Return the user's own `core.pager`; what a repository sets does not count, for looking must not run it."""
    asked = ["git", "-C", str(session.folder), "config", "--show-scope", "-z", "--get-all", "core.pager"]
    try:
        words = subprocess.run(
            asked, capture_output=True, text=True, check=False, encoding="utf-8", errors="replace"
        ).stdout.split("\0")
    except OSError:
        return ""
    pairs = zip(words[::2], words[1::2], strict=False)
    return ([""] + [pager for scope, pager in pairs if scope in ("system", "global", "command")])[-1]
