"""What is published, as data: the files with what each is, and the revision that they are of."""

from __future__ import annotations

import hashlib

from pico.history.git.commit import Commit
from pico.model.diff import Change
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.trace.run import Run

JSON, JSON_LINES, TEXT, YAML, PNG = (
    "application/json",
    "application/jsonl",
    "text/plain",
    "application/yaml",
    "image/png",
)
_MEDIA_TYPES = {
    ".json": JSON, ".jsonl": JSON_LINES, ".yaml": YAML, ".png": PNG, ".md": "text/markdown", ".cff": YAML,
    ".gz": "application/gzip",
}  # fmt: skip


@record
class File:
    """A file of `size` bytes at `path`, in words `name`. `content` is None where it is an object of the store."""

    path: str
    name: str
    media_type: str
    sha256: str
    size: int
    content: bytes | None = None


@record
class Revision:
    """A revision with all that is published of it. `evidence` is the strongest among the runs that led to its state, or
    `planned`; `license` the path of the file that states one."""

    commit: Commit
    setup: Setup
    state: str
    evidence: str
    changes: tuple[Change, ...]
    runs: tuple[Run, ...]
    files: tuple[File, ...]
    license: str | None


def file(path: str, content: bytes, name: str) -> File:
    """Return a file of which the content is at hand; its ending says what it is."""
    sha256, media_type = hashlib.sha256(content).hexdigest(), _media_type(path)
    return File(path=path, name=name, media_type=media_type, sha256=sha256, size=len(content), content=content)


def _media_type(path: str) -> str:
    return next((kind for ending, kind in _MEDIA_TYPES.items() if path.endswith(ending)), TEXT)
