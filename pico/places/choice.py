"""The bench that a worktree means if a command names none: `chosen.json` in its `.pico`, in no commit and no clone."""

from __future__ import annotations

import json
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.disk import write_whole, writing
from pico.places.lab import FOLDER, make_own_folder, own_folder

FILE = "chosen.json"
SCHEMA = "pico.chosen-bench/v1"


def read_choice(root: Path) -> str:
    """Return the word for the bench that the worktree of the lab in `root` chose, empty if it chose none. Raises
    PicoError for a file that can't be read."""
    path = own_folder(root) / FILE
    try:
        return str(json.loads(path.read_text(encoding="utf-8"))["bench"])
    except FileNotFoundError:
        return ""
    except (OSError, ValueError, KeyError, TypeError) as exc:
        hint = "`pico bench use sim` writes it anew"
        raise PicoError(error("chosen-bench", f"{path} can't be read: {exc}", hint=hint)) from exc


def write_choice(root: Path, word: str) -> None:
    """Let the worktree of the lab in `root` mean a bench if a command names none; raises PicoError."""
    data = json.dumps({"schema": SCHEMA, "bench": word}, indent=1) + "\n"
    with writing(root / FOLDER):
        folder = make_own_folder(root)
    write_whole(folder / FILE, data.encode())
