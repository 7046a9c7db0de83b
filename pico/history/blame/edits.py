"""What the working tree says otherwise than the commit that is checked out, as if it were one more commit."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

from pico.history.blame.answer import Answer, Unread, answer
from pico.history.blame.flat import Flat, flatten
from pico.history.blame.follow import Blame
from pico.history.blame.walk import Walker, packaged_units
from pico.manifest.files import read_folder, shown_path


def with_edits(walker: Walker, root: Path, commit: str | None, committed: Answer) -> Answer:
    """Return the answer of a commit (None: nothing is committed) with the manifests of the folder on top.

    The nodes of what was edited have no commit (''). Files that can't be read count as in the commit.
    """
    before = walker.files(commit) if commit else {}
    files, found = read_folder(root)
    shut = {_inside(d.source.path, root): d.summary for d in found if d.source}
    now = {_inside(path, root): data for path, data in files.items()}
    delta: dict[str, Flat | None] = {
        path: flatten(data) for path, data in now.items() if before.get(path) != _object_id(data)
    }
    delta |= dict.fromkeys(before.keys() - now.keys()) | {path: Flat(wrong=why) for path, why in shut.items()}
    if not delta:
        return committed
    blame = walker.blame(commit) if commit else Blame()
    blame.put(delta, "", packaged_units)
    wrong = [Unread("", path, flat.wrong) for path, flat in sorted(delta.items()) if flat and flat.wrong]
    return replace(answer(blame, packaged_units, (*committed.unread, *wrong)), runs=committed.runs)


def _inside(path: str, root: Path) -> str:
    return Path(path).relative_to(shown_path(root)).as_posix()


def _object_id(data: bytes) -> str:
    return hashlib.sha1(b"blob %d\0" % len(data) + data, usedforsecurity=False).hexdigest()
