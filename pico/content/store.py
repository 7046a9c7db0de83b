"""Large data by its content: camera frames, long traces, anything that is too big for a commit.

An object is a file that is named by the SHA-256 of its bytes, `sha256/aa/bb/<hash>` below the store's root. It is
written once, read-only, and never half there: bytes go to `tmp/`, to the disk, and then under their name. Any number of
processes may write at once. The same layout serves a repository (`pico/cas` in its common git directory, so that its
worktrees share one store) and a folder elsewhere that keeps copies.
"""

from __future__ import annotations

import hashlib
import os
import re
import time
import uuid
from collections.abc import Container, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from pico.diagnostics import Diagnostic, PicoError, error
from pico.disk import removed, sweep, unwritable
from pico.places.lab import lab_place, own_folder

CHUNK = 1 << 20
"""Bytes that are read or written at once."""
_ABANDONED = 86400.0
"""Seconds after which nobody is still writing a temporary file."""
_NAME = re.compile(r"[0-9a-f]{64}")


class Store:
    """The objects below `root`, a folder that need not exist yet. Hashes are 64 hexadecimal digits, without `sha256:`.

    Every method raises PicoError: `data-missing` and `data-damaged` name the object, `data-io` what can't be used.
    """

    def __init__(self, root: Path) -> None:
        self.root = root

    def path(self, sha256: str) -> Path:
        """Return where an object lies, or would lie. Whoever writes there without `put` breaks the store."""
        if not _NAME.fullmatch(sha256):
            raise PicoError(error("data-name", f"`{sha256[:80]}` is not a SHA-256: 64 digits and letters a to f"))
        return self.root / "sha256" / sha256[:2] / sha256[2:4] / sha256

    def put(self, source: bytes | Path | Iterable[bytes], *, expected: str | None = None) -> str:
        """Keep `source` (bytes, a file, or pieces in their order) and return its SHA-256; it is on the disk then.

        What is there already counts as new from now on. `expected`: the hash that it must have; nothing is kept where
        it has another.
        """
        with _guarded(self.root):
            fresh, sha256 = self._write(_pieces(source))
            try:
                if expected not in (None, sha256):
                    raise PicoError(_damaged(str(expected), "what arrived", sha256))
                self._place(fresh, self.path(sha256))
            finally:
                fresh.unlink(missing_ok=True)
        return sha256

    def get(self, sha256: str) -> bytes:
        """Return an object; one that is damaged is set aside and not returned."""
        with self.open(sha256) as file, _guarded(self.root):
            return file.read()

    def open(self, sha256: str) -> BinaryIO:
        """Return an object as a file to read. All of it was read and found right before; else as `get`."""
        path = self.path(sha256)
        with _guarded(self.root):
            try:
                file = path.open("rb")
            except FileNotFoundError:
                raise PicoError(missing(sha256, self.root)) from None
            found = _hash(_read(file))
            if found == sha256:
                file.seek(0)
                return file
            file.close()
            self._set_aside(path)
        raise PicoError(_damaged(sha256, f"{path} (now in {self.root / 'damaged'})", found))

    def has(self, sha256: str) -> bool:
        """Return whether an object is there; it may be damaged, which `open` tells."""
        return self.path(sha256).is_file()

    def size(self, sha256: str) -> int:
        """Return the bytes of an object."""
        return self._stat(sha256).st_size

    def age(self, sha256: str) -> float:
        """Return the seconds since an object was last put."""
        return time.time() - self._stat(sha256).st_mtime

    def all(self) -> Iterator[str]:
        """Yield the hashes of the objects that are there, sorted."""
        with _guarded(self.root):
            found = sorted((self.root / "sha256").glob("??/??/*"))
        yield from (p.name for p in found if _NAME.fullmatch(p.name) and p == self.path(p.name))

    def is_intact(self, sha256: str) -> bool:
        """Return whether an object has the bytes of its name; one that has not is set aside."""
        try:
            self.open(sha256).close()
        except PicoError as exc:
            if exc.diagnostics[0].code != "data-damaged":
                raise
            return False
        return True

    def remove(self, sha256: str, *, older: float = 0.0) -> int:
        """Remove an object that was last put more than `older` seconds ago, and return the bytes that this freed.

        A `put` of the same bytes meanwhile wins: it finds its object in place, or writes it again.
        """
        path, aside = self.path(sha256), self._temporary()
        with _guarded(self.root):
            try:
                path.rename(aside)
            except FileNotFoundError:
                return 0
            found = aside.stat()
            if time.time() - found.st_mtime < older:
                aside.rename(path)
                return 0
            aside.unlink()
            return found.st_size

    def sweep(self, needed: Container[str] = ()) -> int:
        """Remove what killed writers left, and damaged copies of objects that are there or not `needed`, each after a
        day; return the bytes that this freed."""
        freed = 0
        with _guarded(self.root):
            unique = [p for p in (self.root / "damaged").glob("*") if p.name in needed and not self.has(p.name)]
            for path in (*(self.root / "tmp").glob("*"), *(self.root / "damaged").glob("*")):
                found = path.stat()
                if path not in unique and time.time() - found.st_mtime > _ABANDONED:
                    path.unlink(missing_ok=True)
                    freed += found.st_size
        return freed

    def _write(self, pieces: Iterable[bytes]) -> tuple[Path, str]:
        """Write pieces to a new temporary file, down to the disk; return it and the hash of what it holds."""
        fresh, counted = self._temporary(), hashlib.sha256()
        with removed(fresh), fresh.open("xb") as file:
            for piece in pieces:
                counted.update(piece)
                file.write(piece)
            file.flush()
            os.fsync(file.fileno())
        return fresh, counted.hexdigest()

    def _place(self, fresh: Path, path: Path) -> None:
        """Give a complete file its name, and see that the disk has the name, too."""
        with suppress(OSError):  # a share may not know permissions
            fresh.chmod(0o444)
        made = [p for p in path.parents if p.is_relative_to(self.root) and not p.exists()]
        path.parent.mkdir(parents=True, exist_ok=True)
        fresh.replace(path)
        for folder in (path.parent, *(p.parent for p in made)):
            _sync(folder)

    def _set_aside(self, path: Path) -> None:
        with suppress(OSError):  # a read-only share: it stays, and is refused each time
            (self.root / "damaged").mkdir(exist_ok=True)
            path.replace(self.root / "damaged" / path.name)

    def _temporary(self) -> Path:
        with _guarded(self.root):
            (self.root / "tmp").mkdir(parents=True, exist_ok=True)
        here = os.uname().nodename  # a process of another machine that shares this store may live
        with suppress(OSError):
            sweep(self.root / "tmp", f"{here}-*")
        return self.root / "tmp" / f".{here}-{uuid.uuid4().hex}.{os.getpid()}.tmp"

    def _stat(self, sha256: str) -> os.stat_result:
        path = self.path(sha256)
        with _guarded(self.root):
            try:
                return path.stat()
            except FileNotFoundError:
                raise PicoError(missing(sha256, self.root)) from None


def store_in(common: Path) -> Store:
    """Return the store of a repository, by Git's folder that its worktrees share."""
    return Store(common / "pico" / "cas")


def store_of(root: Path) -> Store:
    """Return the store of the lab in folder `root`: its repository's, outside Git one beside its bench."""
    place = lab_place(root)
    return store_in(place.common) if place else Store(own_folder(root) / "cas")


def missing(sha256: str, where: Path | str) -> Diagnostic:
    """Return what is said of an object that is not there."""
    hint = "`pico data pull` brings it from where the data of this lab is kept"
    return error("data-missing", f"the object {sha256} is not in {where}", hint=hint)


def _damaged(sha256: str, where: str, found: str) -> Diagnostic:
    hint = "`pico data pull` brings an intact copy, `pico data fsck` looks at all objects"
    text = f"the object {sha256} is damaged: {where} has the SHA-256 {found[:12]}..."
    return error("data-damaged", text, hint=hint)


def _pieces(source: bytes | Path | Iterable[bytes]) -> Iterator[bytes]:
    if isinstance(source, bytes):
        yield source
    elif isinstance(source, Path):
        with source.open("rb") as file:
            yield from _read(file)
    else:
        yield from source


def _read(file: BinaryIO) -> Iterator[bytes]:
    while piece := file.read(CHUNK):
        yield piece


def _hash(pieces: Iterable[bytes]) -> str:
    counted = hashlib.sha256()
    for piece in pieces:
        counted.update(piece)
    return counted.hexdigest()


def _sync(folder: Path) -> None:
    """Write a folder's names to the disk, where the system can."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


@contextmanager
def _guarded(root: Path) -> Iterator[None]:
    """Say what the system refused, instead of a traceback."""
    try:
        yield
    except OSError as exc:
        what = f"the data in {root} can't be used{f': {exc.filename}' if exc.filename else ''}"
        raise PicoError(unwritable(root, exc, what=what, code="data-io")) from exc
