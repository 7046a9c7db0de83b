"""Where git keeps its own files for a folder, read from the files alone: for what must cost nothing."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Places:
    """The top of a working tree, git's folder of that one alone, and the one that all worktrees share."""

    top: Path
    own: Path
    common: Path


def places(folder: Path) -> Places | None:
    """Return the places of the working tree around `folder`, None outside of one."""
    for top in (folder.resolve(), *folder.resolve().parents):
        own = top / ".git"
        if own.is_file():  # a worktree or a submodule: a file that names the folder
            named = small(own).decode(errors="surrogateescape").removeprefix("gitdir:").strip()
            own = (top / named).resolve()
        if own.is_dir():
            shared = small(own / "commondir").decode(errors="surrogateescape").strip()
            return Places(top, own, (own / shared).resolve() if shared else own)
    return None


def small(path: Path) -> bytes:
    """Return what a file holds; nothing for one that can't be read, or that is too large to be one of git's own."""
    try:
        return path.read_bytes() if path.stat().st_size < 1_000_000 else b""
    except OSError:
        return b""
