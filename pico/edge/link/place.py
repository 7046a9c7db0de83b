"""Where the socket of a bench is: its path may be no longer than about 100 bytes, so it lies in a folder for temporary
files, and `edge.json` in the folder of the bench names it."""

from __future__ import annotations

import hashlib
import os
import socket
import tempfile
from pathlib import Path

from pico.base.state_files import EDGE
from pico.diagnostics import PicoError, error
from pico.disk import writing
from pico.places.bench import BenchPlace


def make(bench: BenchPlace) -> Path:
    """Return where the socket of a bench is to be, in a folder that is only this user's; raises PicoError."""
    folder = Path(tempfile.gettempdir()) / f"pico-{os.getuid()}"
    with writing(folder, code="link"):
        folder.mkdir(mode=0o700, exist_ok=True)
    found = folder.lstat()
    if found.st_uid != os.getuid() or found.st_mode & 0o077 or folder.is_symlink():
        raise PicoError(error("link", f"{folder} is open to others", hint=f"`chmod 700 {folder}`, if it is yours"))
    return folder / _name(bench)


def _name(bench: BenchPlace) -> str:
    return f"{hashlib.sha256(os.fsencode(bench.folder.resolve())).hexdigest()[:16]}.sock"


def announce(bench: BenchPlace, path: Path) -> None:
    """Let clients find the socket; raises PicoError."""
    EDGE.write(_note(bench), {"socket": str(path), "pid": os.getpid()}, durable=False)


def withdraw(bench: BenchPlace, path: Path) -> None:
    """Let nobody find the socket any more."""
    _note(bench).unlink(missing_ok=True)
    path.unlink(missing_ok=True)


def find(bench: BenchPlace) -> Path | None:
    """Return the socket of the edge that serves a bench; None where none answers.

    A note that came along with a copy of the lab's folder names the socket of another bench, and counts for nothing.
    """
    path = EDGE.read(_note(bench), lambda note: Path(note["socket"]))
    if path is None:
        return None
    try:
        if path.name != _name(bench) or path.lstat().st_uid != os.getuid():
            return None
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(str(path))
    except (OSError, ValueError):
        return None
    return path


def _note(bench: BenchPlace) -> Path:
    return EDGE.path(bench.folder)
