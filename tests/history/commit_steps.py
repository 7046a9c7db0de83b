"""Kills a process group just before or after a step of a commit: what writes a file, runs git, or takes a lock."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from pathlib import Path

from pico.history import git
from pico.history.writing import files as write_files
from pico.history.writing import index_lock, landing

WATCHED: tuple[tuple[object, str], ...] = (
    (git, "run"), (os, "link"), (Path, "replace"), (Path, "unlink"), (landing, "_copy"), (write_files, "write_file"),
    (index_lock, "_claimed"),
)  # fmt: skip


def kill_at(step: int, *, after: bool) -> None:
    """Let this process, and all that it started, be killed at the `step`-th call of what a commit does."""
    done = 0

    def watch(owner: object, name: str) -> None:
        real = getattr(owner, name)

        def counted(*arguments: object, **options: object) -> object:
            nonlocal done
            done += 1
            mine = done == step
            if mine and not after:
                os.killpg(0, signal.SIGKILL)
            try:
                return real(*arguments, **options)
            finally:
                if mine:
                    os.killpg(0, signal.SIGKILL)

        setattr(owner, name, counted)

    for owner, name in WATCHED:
        watch(owner, name)


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
