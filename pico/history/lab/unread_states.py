"""States that lie in a lab's folder and are not read: under another name, hidden, or in a folder that is left out."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from pico.manifest.edit import components_of
from pico.manifest.file_names import hidden, named_as_manifest
from pico.manifest.links import MOST, small_state

_OWN = (".git", ".pico")


def unread_states(root: Path, parts: Collection[str]) -> Mapping[str, str]:
    """Return which of `parts` a state names that lies in the folder `root` and is not read, and the path of its file.

    At most `MOST` files are looked at. What lies in another repository or lab is that one's.
    """
    found: dict[str, str] = {}
    for path in _unread(root):
        with contextlib.suppress(OSError):
            if data := small_state(path):
                inside = os.path.relpath(path, root)
                found = dict.fromkeys(sorted(components_of(data) & set(parts)), inside) | found
    return found


def _unread(root: Path) -> Iterator[Path]:
    seen = 0
    for at, folders, names in os.walk(root):
        folder = os.path.relpath(at, root)
        if folder != "." and {".git", "lab.yaml"} & {*folders, *names}:
            folders.clear()
            continue
        folders[:] = sorted(f for f in folders if f not in _OWN)
        for name in sorted(names):
            seen += 1
            if seen > MOST:
                return
            if not named_as_manifest(name) or hidden(str(Path(folder, name))):
                yield Path(at, name)
