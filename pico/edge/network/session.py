"""The session of a checkout: what a coordinator knows it by, so that a lease lasts from one command to the next."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from pico.base.plain_files import read_text
from pico.base.state_files import RUNS_BEGUN, SESSION

VARIABLE = "PICO_SESSION"


def session_in(folder: Path) -> str:
    """Return the session that a checkout keeps in `folder`, made where there is none; raises PicoError. `PICO_SESSION`
    comes before it, for what runs in the name of somebody elsewhere."""
    if said := os.environ.get(VARIABLE):
        return said
    path = SESSION.path(folder)
    try:
        if found := read_text(path, "ascii").strip():
            return found
    except (OSError, ValueError):
        pass
    made = secrets.token_hex(16)
    SESSION.put(path, made.encode())
    return made


def begun(folder: Path, run: str) -> None:
    """Note that this checkout began a run, which it will carry into a commit; raises PicoError."""
    if run not in runs_begun(folder):
        RUNS_BEGUN.put(RUNS_BEGUN.path(folder), "".join(f"{one}\n" for one in [*runs_begun(folder), run]).encode())


def runs_begun(folder: Path) -> tuple[str, ...]:
    """Return the runs that this checkout began, in order."""
    try:
        return tuple(read_text(RUNS_BEGUN.path(folder)).split())
    except (OSError, UnicodeError):
        return ()
