"""The session of a checkout: what a coordinator knows it by, so that a lease lasts from one command to the next."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from pico.base.state_files import RUNS_BEGUN, SESSION
from pico.disk import write_whole

VARIABLE = "PICO_SESSION"


def session_in(folder: Path) -> str:
    """Return the session that a checkout keeps in `folder`, made where there is none; raises PicoError. `PICO_SESSION`
    comes before it, for what runs in the name of somebody elsewhere."""
    if said := os.environ.get(VARIABLE):
        return said
    path = SESSION.path(folder)
    try:
        if found := path.read_text(encoding="ascii").strip():
            return found
    except (OSError, ValueError):
        pass
    made = secrets.token_hex(16)
    write_whole(path, made.encode(), folders=True)
    return made


def begun(folder: Path, run: str) -> None:
    """Note that this checkout began a run, which it will carry into a commit; raises PicoError."""
    if run not in runs_begun(folder):
        write_whole(
            RUNS_BEGUN.path(folder), "".join(f"{one}\n" for one in [*runs_begun(folder), run]).encode(), folders=True
        )


def runs_begun(folder: Path) -> tuple[str, ...]:
    """Return the runs that this checkout began, in order."""
    try:
        return tuple(RUNS_BEGUN.path(folder).read_text(encoding="utf-8").split())
    except (OSError, UnicodeError):
        return ()
