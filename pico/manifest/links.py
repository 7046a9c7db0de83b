"""What lies behind a link to a folder: links are not followed, but manifests there must not be missed in silence."""

from __future__ import annotations

import os
import stat
from collections import deque
from dataclasses import replace
from pathlib import Path, PurePosixPath

from pico.diagnostics import Diagnostic
from pico.manifest.file_names import (
    MAX_BYTES,
    about,
    declares_api,
    hidden,
    is_manifest,
    linked,
    named_as_manifest,
    unseen,
)

_BEGINNING = 4096
MOST = 10_000
"""Files and folders that are looked at behind one link. A folder with more holds data, and no 10 to 50 components."""


def manifest_behind(place: Path, root: Path, shown: str, target: str) -> Diagnostic | None:
    """Return what to say of a link, called `shown`, to `target`, which is at `place`; None where no manifest is there.

    What lies in the folder of the lab itself, `root`, is read where it lies.
    """
    try:
        found = _search(Path(os.path.realpath(place)), Path(os.path.realpath(root)), named=named_as_manifest(shown))
    except FileNotFoundError:
        return broken_link(shown, target)
    except OSError as exc:
        why = f"a link to {target}, which can't be read: {exc.strerror}"
        return unseen(shown, why, "make it readable, or remove the link")
    if found is None:
        summary = f"a link to {target}, which holds more than {MOST} files: manifests among them are not read"
        hint = "if it leads to data, put the link into a folder whose name begins with a dot"
        return replace(about(shown, "symlink", summary, hint), severity="warning")
    return linked(shown, target, found) if found else None


def broken_link(shown: str, target: str) -> Diagnostic | None:
    """Return what to say of a link that leads nowhere; None where it is called as no folder and no manifest is."""
    if any(PurePosixPath(path).suffix and not named_as_manifest(path) for path in (shown, target)):
        return None
    hint = "bring back what it leads to, or remove it; a link in a folder whose name begins with a dot is left alone"
    return unseen(shown, f"a link to {target}, which is not there", hint)


def _search(goal: Path, root: Path, *, named: bool) -> str | None:
    """Return the path of a manifest at or below `goal`, but not read as one of the lab in `root`; empty for none, None
    where there is too much to look at. `named`: the link is called as a manifest is. Raises OSError."""
    inside = goal.relative_to(root).as_posix() if goal.is_relative_to(root) else ""
    folder = stat.S_ISDIR(goal.stat().st_mode)
    if goal.is_relative_to(root) and not hidden(inside) and (folder or is_manifest(inside)):
        return ""
    if not folder:
        return goal.name if named and _ours(goal) else ""
    below, known, seen = deque([goal]), {goal, root}, 0
    while below:
        at = below.popleft()
        for entry in sorted(os.scandir(at), key=lambda e: e.name):
            seen += 1
            place = Path(os.path.realpath(entry.path))
            if seen > MOST:
                return None
            if hidden(entry.name) or place in known:
                continue
            if place.is_dir():
                known.add(place)
                below.append(place)
            elif named_as_manifest(entry.name) and place.exists() and _ours(place):
                return os.path.relpath(entry.path, goal)
    return ""


def _ours(path: Path) -> bool:
    return declares_api(head_of(path))


def small_state(path: Path) -> bytes:
    """Return a small file that may hold a state; nothing of others. Raises OSError."""
    about_it = path.lstat()
    if not stat.S_ISREG(about_it.st_mode) or about_it.st_size > MAX_BYTES:
        return b""
    with path.open("rb", buffering=0) as file:
        start = file.read(_BEGINNING)
        return start + file.read() if b"LabState" in start else b""


def head_of(path: Path) -> bytes:
    """Return the beginning of a regular file, of a link's target too; nothing of what is no file. Raises OSError."""
    if not stat.S_ISREG(path.stat().st_mode):
        return b""
    with path.open("rb") as file:
        return file.read(MAX_BYTES)
