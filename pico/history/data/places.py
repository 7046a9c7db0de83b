"""Where copies of a lab's data are kept: a folder such as a mounted share, or what git-lfs has, or see `bucket`."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from pico.content.store import Store
from pico.diagnostics import PicoError, error
from pico.disk import beside, replace_whole, sweep, writing
from pico.history.data.needs import Needs
from pico.history.data.pieces import Heard, pieces
from pico.history.git import command as git
from pico.history.repository.repository import Repository

SETTING = "pico.data.remote"
"""What `git config` calls the place; local, for a repository must not say where somebody's data goes."""

LFS = "lfs"
"""The place where git-lfs keeps what it fetched, and what it will push."""


class CopyPlace(Protocol):
    """Keeps copies of objects; every method raises PicoError."""

    name: str

    def present(self, wanted: Needs) -> frozenset[str]:
        """Return which of the objects are there, with the size that they should have."""
        ...

    def send(self, sha256: str, store: Store, heard: Heard) -> None:
        """Copy an object of `store` to the place, whole or not at all."""
        ...

    def fetch(self, sha256: str, store: Store, heard: Heard) -> None:
        """Copy an object of the place into `store`, whole or not at all."""
        ...


def place_of(repository: Repository, word: str | None) -> CopyPlace | None:
    """Return the place that `word` names (a folder, an URL such as `s3://bucket/lab`, or `lfs`), else the one
    configured, or None where there is none. A relative folder counts from the top of the working tree.

    Raises PicoError.
    """
    word = word or configured(repository)
    if not word:
        return None
    if word == LFS:
        return LfsObjects(repository)
    word = word.removeprefix("file://")
    if "://" in word:
        from pico.history.data.bucket import Bucket

        return Bucket(word)
    folder = (repository.root / Path(word).expanduser()).resolve()
    if not folder.is_dir():
        hint = "mount the share, or make the folder: PICO does not, lest copies end up where a share is not mounted"
        raise PicoError(error("data-place", f"there is no folder {folder} to keep data in", hint=hint))
    return Folder(folder)


def configured(repository: Repository) -> str:
    """Return the place that `git config pico.data.remote` names; empty where it names none."""
    try:
        return git.run(repository.root, ["config", "--get", SETTING], doing="read its configuration").strip()
    except PicoError:
        return ""


class Folder:
    """A folder with the layout of a store."""

    def __init__(self, folder: Path) -> None:
        self.name, self._store = str(folder), Store(folder)

    def present(self, wanted: Needs) -> frozenset[str]:
        return frozenset(n.sha256 for n in wanted.values() if self._store.has(n.sha256))

    def send(self, sha256: str, store: Store, heard: Heard) -> None:
        _copy(sha256, store, self._store, heard)
        self._store.open(sha256).close()  # reads it again, as it now is there

    def fetch(self, sha256: str, store: Store, heard: Heard) -> None:
        _copy(sha256, self._store, store, heard)


class LfsObjects:
    """The objects of git-lfs in a repository: `lfs/objects/aa/bb/<hash>` in the folder that its worktrees share. Those
    of pointers that are committed go with `git lfs push` and come with `git lfs fetch`."""

    def __init__(self, repository: Repository) -> None:
        self._root = repository.common / "lfs" / "objects"
        self.name = str(self._root)

    def present(self, wanted: Needs) -> frozenset[str]:
        return frozenset(n.sha256 for n in wanted.values() if self._path(n.sha256).is_file())

    def send(self, sha256: str, store: Store, heard: Heard) -> None:
        path = self._path(sha256)
        with store.open(sha256) as file:
            if not path.is_file():
                with writing(path, code="data-io"):
                    path.parent.mkdir(parents=True, exist_ok=True)
                    sweep(path.parent)
                    replace_whole(path, pieces(file, heard), beside(path))

    def fetch(self, sha256: str, store: Store, heard: Heard) -> None:
        with self._path(sha256).open("rb") as file:
            store.put(pieces(file, heard), expected=sha256)

    def _path(self, sha256: str) -> Path:
        return self._root / sha256[:2] / sha256[2:4] / sha256


def _copy(sha256: str, source: Store, target: Store, heard: Heard) -> None:
    with source.open(sha256) as file:
        target.put(pieces(file, heard), expected=sha256)
