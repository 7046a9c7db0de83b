"""Kills a command of the real `pico` at a random instant, and looks at what it left."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import forking


def git(folder: Path, *words: str, ends: tuple[int, ...] = (0,)) -> str:
    done = subprocess.run(["git", *words], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode in ends, done.stdout + done.stderr
    return done.stdout.strip()


def killed(folder: Path, words: tuple[str, ...], seconds: float) -> bool:
    """Run `pico WORDS`, kill it with all that it started after so long; return whether it was killed."""
    running = forking.started(
        forking.PICO, *words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        running.wait(seconds)
        return False
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)
        running.wait()
        _guards_ended(folder / ".git" / "index.lock")
        return True


def _guards_ended(lock: Path) -> None:
    """Wait until the guard of what was killed has brought it to its end; a lock that a killed git left stays."""
    deadline = time.monotonic() + 3.0
    while lock.exists() and time.monotonic() < deadline:
        time.sleep(0.01)


def duration(folder: Path, words: tuple[str, ...]) -> float:
    """Return how long a command takes when nobody kills it [s]."""
    began = time.monotonic()
    assert not killed(folder, words, 120.0)
    return time.monotonic() - began


def instants(count: int, longest: float, seed: int) -> list[float]:
    """Return when to kill: at random within equal parts of the command's time."""
    draw = random.Random(seed)
    return [longest * (i + draw.random()) / count for i in range(count)]


def _staged(folder: Path) -> str:
    """Return the tree that is staged, read from a copy of the index: the lock of a killed git may lie beside it."""
    copy = folder / ".git" / "index of the test"
    shutil.copy(folder / ".git" / "index", copy)
    environment = os.environ | {"GIT_INDEX_FILE": str(copy)}
    done = subprocess.run(
        ["git", "write-tree"], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )
    copy.unlink()
    return done.stdout.strip()


def require_whole(folder: Path, allowed: set[str]) -> str:
    """Assert that a repository is sound, HEAD one of the `allowed` commits, and nothing staged that takes HEAD back.

    Returns HEAD.
    """
    git(folder, "fsck", "--strict", "--no-dangling")
    head = git(folder, "rev-parse", "HEAD")
    assert head in allowed or allowed & set(git(folder, "rev-list", "--parents", "-n1", head).split()[1:]), head
    merging = (folder / ".git/MERGE_HEAD").exists()
    staged = _staged(folder)
    trees = {git(folder, "rev-parse", f"{c}^{{tree}}") for c in allowed | {head}}
    now = git(folder, "rev-parse", "HEAD^{tree}")
    assert merging or staged in trees, "what is staged is neither the old state nor the new one"
    parents = git(folder, "rev-list", "--parents", "-n1", head).split()[1:]
    reversal = {git(folder, "rev-parse", f"{p}^{{tree}}") for p in parents if head not in allowed} - {now}
    assert merging or staged not in reversal, "the reversal of HEAD is staged"
    return head
