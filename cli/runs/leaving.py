"""A recipe that a process of its own runs, without a terminal, and what it said so far."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from pico.base.plain_files import open_file, read_text, set_aside
from pico.base.state_files import RECIPE_PROCESS
from pico.diagnostics import ExitCode, PicoError
from pico.disk import writing
from pico.edge.network.meant import word_for

from ..session import Session

if TYPE_CHECKING:
    from pico.bench.bench import Bench
    from pico.recipes.log import Log

PAUSE = 0.2
"""Seconds between two looks at what it said."""


def leave(session: Session, bench: Bench, log: Log, unattended: bool) -> None:
    """Have a process of its own go on with a run of a recipe that was begun; raises PicoError where what it says can't
    be kept."""
    words = [sys.executable, "-P", "-m", str(__package__).partition(".")[0], "-C", str(bench.root)]
    words += ["--bench", word_for(bench.place)]
    words += ["run", "--resume", log.about.name, "--yes", *(["--unattended"] if unattended else [])]
    words += ["--fidelity", bench.fidelity] if bench.asked else []
    with writing(_said(log.path)):
        set_aside(_said(log.path))
    with writing(_said(log.path)), _said(log.path).open("wb") as said:
        process = subprocess.Popen(
            words, stdin=subprocess.DEVNULL, stdout=said, stderr=subprocess.STDOUT, start_new_session=True
        )
    RECIPE_PROCESS.put(log.path.with_suffix(".pid"), str(process.pid).encode())


def left(bench: Bench, word: str | None) -> Path | None:
    """Return the log of the run of a recipe that was left to a process of its own, whose id begins or ends with `word`;
    None where there is none, or the last one where None and it goes on."""
    from pico.recipes.log import logs

    for path in logs(bench.place):
        if _said(path).exists() and (
            _goes_on(path) if word is None else path.stem.startswith(word) or path.stem.endswith(word)
        ):
            return path
    return None


def follow(session: Session, path: Path) -> int:
    """Show what such a run says until it is over, and return its exit code as far as its log tells it."""
    from pico.recipes.log import Log

    with os.fdopen(open_file(_said(path), os.O_RDONLY), "rb") as said:
        while True:
            over = not _goes_on(path)
            if text := said.read().decode(errors="replace").rstrip("\n"):
                session.say(text)
            if over:
                break
            time.sleep(PAUSE)
    how = Log.read(path).about.ended
    return int({"done": ExitCode.DONE, "": ExitCode.INTERRUPTED}.get(how, ExitCode.ERROR))


def _goes_on(path: Path) -> bool:
    from pico.recipes.log import Log

    try:
        if Log.read(path).about.ended:
            return False
        os.kill(int(read_text(path.with_suffix(".pid"))), 0)
    except (PicoError, OSError, ValueError):
        return False
    return True


def _said(path: Path) -> Path:
    return path.with_suffix(".out")
