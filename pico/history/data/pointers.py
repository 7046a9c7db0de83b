"""Git LFS, for who asks for it: pointers beside runs, for a commit, and their objects where git-lfs looks for them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from pico.content.store import Store
from pico.diagnostics import PicoError, did_you_mean, error
from pico.disk import disk_trouble, write_whole
from pico.history.data.places import LfsObjects
from pico.history.repository.repository import Repository
from pico.model.record import record
from pico.model.trace.run import Run
from pico.runs.artifacts import artifact_paths
from pico.runs.files import read_runs

ATTRIBUTES = "runs/**/artifacts/** filter=lfs diff=lfs merge=lfs -text"
"""What `.gitattributes` must say, so that git-lfs puts the data in the place of pointers where it is installed."""


@record
class Pointed:
    """Pointer files that were written, by path relative to the lab, and the bytes that they stand for. `attributes`:
    whether `.gitattributes` got its line."""

    files: tuple[str, ...]
    size: int
    attributes: bool


def pointer(sha256: str, size: int) -> bytes:
    """Return the pointer file of an object; format: git-lfs, docs/spec.md, version 1."""
    return f"version https://git-lfs.github.com/spec/v1\noid sha256:{sha256}\nsize {size}\n".encode()


def write_pointers(repository: Repository, lab: Path, store: Store, runs: Sequence[str] = ()) -> Pointed:
    """Write pointers for the artifacts of the runs in the folder `lab` (all, or those named), and give git-lfs their
    objects. Nothing is committed.

    Raises PicoError for an unknown run, and for an object that is missing or damaged; then no pointer of it is written.
    """
    place = LfsObjects(repository)
    written, size = [], 0
    named = {path: artifact for run in _runs(lab, runs) for path, artifact in artifact_paths(run).items()}
    with disk_trouble(lab, "not all pointers were written"):
        for path, artifact in named.items():
            place.send(artifact.sha256, store, lambda _: None)
            content, file = pointer(artifact.sha256, artifact.size), lab / path
            if not file.is_file() or file.read_bytes() != content:
                write_whole(file, content, folders=True)
                written.append(path)
                size += artifact.size
    return Pointed(files=tuple(written), size=size, attributes=bool(named) and _attribute(lab / ".gitattributes"))


def _runs(lab: Path, names: Sequence[str]) -> list[Run]:
    there = [p for p in sorted(lab.glob("runs/*/*/*/run.json")) if not p.is_symlink()]
    found = {d.id: d for d in read_runs({p.relative_to(lab).as_posix(): p.read_bytes() for p in there})}
    unknown = [name for name in names if name not in found]
    if unknown:
        hint = did_you_mean(unknown[0], found) or "`pico runs list` shows the runs"
        raise PicoError(error("unknown-run", f"there is no run {', '.join(unknown)} in {lab / 'runs'}", hint=hint))
    return [d for name, d in found.items() if not names or name in names]


def _attribute(path: Path) -> bool:
    """Add the line for git-lfs, where it is missing."""
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    if ATTRIBUTES in text.splitlines():
        return False
    write_whole(path, f"{text}{'' if not text or text.endswith(chr(10)) else chr(10)}{ATTRIBUTES}\n".encode())
    return True
