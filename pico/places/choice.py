"""The bench that a worktree means if a command names none: `chosen.json` in its `.pico`, in no commit and no clone."""

from __future__ import annotations

from pathlib import Path

from pico.base.state_files import CHOSEN
from pico.disk import writing
from pico.places.lab import FOLDER, make_own_folder, own_folder


def read_choice(root: Path) -> str:
    """Return the word for the bench that the worktree of the lab in `root` chose, empty if it chose none. Raises
    PicoError for a file that can't be read."""
    return CHOSEN.read(CHOSEN.path(own_folder(root)), lambda document: str(document["bench"])) or ""


def write_choice(root: Path, word: str) -> None:
    """Let the worktree of the lab in `root` mean a bench if a command names none; raises PicoError."""
    with writing(root / FOLDER):
        folder = make_own_folder(root)
    CHOSEN.write(CHOSEN.path(folder), {"bench": word}, indent=1)
