"""Kills a process just before or after a step of what writes into a repository: it writes a file, runs git, takes a
lock."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from pico.history.git import command as git
from pico.history.lab import files as write_files
from pico.history.writing import index_lock, locked_git

Watched = Sequence[tuple[object, str]]
WATCHED: Watched = (
    (git, "run"), (os, "link"), (Path, "replace"), (Path, "unlink"), (locked_git, "copy_index"),
    (write_files, "write_file"), (index_lock, "_claimed"),
)  # fmt: skip
EVERY: Watched = (
    (subprocess, "run"), (subprocess, "Popen"), (os, "link"), (os, "replace"), (os, "rename"), (os, "unlink"),
    (os, "mkdir"), (os, "rmdir"), (os, "write"), (os, "fsync"), (os, "open"), (locked_git, "copy_index"),
)  # fmt: skip
"""Every call of git, before it, once it runs, and after it; and every write."""


def kill_at(
    step: int, *, after: bool, watched: Watched = WATCHED, by: signal.Signals = signal.SIGKILL, group: bool = True
) -> Callable[[], int]:
    """Let this process, and with `group` all that it started, get a signal at the `step`-th call of what is watched.

    Returns what tells how many calls there were.
    """
    done = 0

    def hit() -> None:
        if group:
            os.killpg(0, by)
        else:
            os.kill(os.getpid(), by)

    def watch(owner: object, name: str) -> None:
        real = getattr(owner, name)

        def counted(*arguments: object, **options: object) -> object:
            nonlocal done
            done += 1
            mine = done == step
            if mine and not after:
                hit()
            try:
                return real(*arguments, **options)
            finally:
                if mine and after:
                    hit()

        setattr(owner, name, counted)

    for owner, name in watched:
        watch(owner, name)
    return lambda: done


def forked(work: Callable[[], object]) -> bool:
    """Do something in a process group of its own; return whether it came to its end."""
    child = os.fork()
    if not child:
        try:
            os.setsid()
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, 1)
            os.dup2(null, 2)
            work()
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)
    return not os.WIFSIGNALED(status)


def guards_ended(own: Path, seconds: float = 30.0) -> None:
    """Wait until what was killed is brought to its end, `own` being git's folder of the working tree."""
    deadline = time.monotonic() + seconds
    while (own / "index.lock").exists():
        assert time.monotonic() < deadline, "nobody cleared up"
        time.sleep(0.01)
