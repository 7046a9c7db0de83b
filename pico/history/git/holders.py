"""Whose a lock of git is, as far as that can be told, for whoever finds it in the way."""

from __future__ import annotations

import time
from pathlib import Path

from pico.diagnostics import Diagnostic, error


def held(lock: Path, root: Path, waited: float = 0.0) -> Diagnostic:
    """Say that a lock is in the way in the working tree `root`: its path, its age, who has it and what to do about it.

    `waited`: the seconds for which somebody hoped that it would go.
    """
    try:
        age = time.time() - lock.stat().st_mtime
    except OSError:
        age = 0.0
    running = git_processes(root)
    who = f"held by {running[0]}" if running else "no git command is seen running here"
    hint = "end that command, or close its editor" if running else f"if none is running anywhere: `rm {lock}`"
    patience = f"; it was waited for {waited:g} s, and nothing was written" if waited else ""
    text = f"{lock} is there for {age:.0f} s, and not of PICO's making: {who}{patience}"
    return error("git-locked", text, hint=hint)


def git_processes(root: Path) -> list[str]:
    """Return the git commands that run in a working tree, as the kernel shows them (Linux; nothing elsewhere)."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
            if words[0].rsplit(b"/", 1)[-1] == b"git" and (folder / "cwd").resolve().is_relative_to(root):
                said = b" ".join(words[:3]).decode(errors="replace").strip()
                found.append(f"`{said}` (process {folder.name})")
        except OSError:
            continue
    return found
