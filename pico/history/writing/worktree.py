"""Files of the working tree brought from one tree to another; what somebody edited in between is kept.

A file is written by git, with the filters, line ends and modes that the repository asks for, into a folder of PICO's
own, and takes the place of the old one when all of them are whole and on the disk: a kill leaves none of them half.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha1
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.disk import unwritable
from pico.history.writing.locked_git import LockedGit

_NOTHING = "0" * 40
_FOLDER = "folder"
_GITLINK, _PROGRAM = "160000", "100755"
_MANY = 200
"""Paths that git is given in one call."""


@dataclass(frozen=True)
class WantedFile:
    """How a file is to be: its mode and blob (zeros for none); `known`: the blobs that it may hold now."""

    mode: str
    blob: str
    known: frozenset[str]


def bring(under: LockedGit, known: Sequence[str], to: str, begin: Callable[[], None] | None = None) -> tuple[str, ...]:
    """Let each file be as in the tree `to` where it is as in one of the `known`; return the paths of the others.

    Files that no two of the trees hold otherwise are not looked at, nor those that a sparse checkout leaves out. The
    index of `under` then holds the tree `to` and nothing else. With `begin`, which is called before anything is
    written, PicoError is raised instead where there are others, or files as in `to` that nobody put there. Raises
    PicoError where the disk does not allow it; some files may then be as in `to` already.
    """
    root, fresh = under.at.root, under.at.private / "files"
    under.git("read-tree", to, doing="read the files of a commit")
    wanted = _wanted(under, known, to)
    now = _present(under, wanted)
    kept = tuple(sorted(p for p, w in wanted.items() if now[p] not in (w.known if begin else w.known | {w.blob})))
    if begin:
        _refuse(kept, wanted)
        begin()
    todo = {p: w for p, w in wanted.items() if p not in kept and not _is_so(root / p, now[p], w)}
    try:
        for path in (p for p, w in todo.items() if w.blob == _NOTHING):
            _take_away(root, path)
        coming = [p for p, w in todo.items() if w.blob != _NOTHING]
        rules = [p for p in coming if Path(p).name == ".gitattributes"]  # git writes the others as these say
        for paths in (rules, [p for p in coming if p not in rules]):
            _prepare(under, paths, fresh)
            for path in paths:
                _put(root, path, fresh / path)
    except OSError as exc:
        raise PicoError(unwritable(Path(exc.filename or root), exc, code="folder")) from exc
    finally:
        shutil.rmtree(fresh, ignore_errors=True)
    under.git("update-index", "-q", "--refresh", doing="look at the files", ends=(0, 1))
    return kept


def _wanted(under: LockedGit, known: Sequence[str], to: str) -> dict[str, WantedFile]:
    left_out = _left_out(under)
    found: dict[str, WantedFile] = {}
    for tree in known:
        words = under.git("diff-tree", "-r", "-z", "--no-renames", tree, to, doing="compare two commits").split("\0")
        for told, path in zip(words[::2], words[1::2], strict=False):
            was, mode, before, after = told.removeprefix(":").split(" ")[:4]
            if path in left_out or _GITLINK in (was, mode):
                continue
            also = found[path].known if path in found else frozenset()
            found[path] = WantedFile(mode, after, also | {before})
    return found


def _left_out(under: LockedGit) -> set[str]:
    """Return the files that the working tree is not to have (a sparse checkout)."""
    entries = under.on(str(under.at.index)).git("ls-files", "-t", "-z", doing="list the files").split("\0")
    return {entry[2:] for entry in entries if entry.startswith("S ")}


def _present(under: LockedGit, wanted: Mapping[str, WantedFile]) -> dict[str, str]:
    """Return by path the blob that each file would be, zeros where there is none."""
    root = under.at.root
    gone = {root / p for p, w in wanted.items() if w.blob == _NOTHING}
    found = {path: _odd(root, path, gone) for path in wanted}
    plain = [path for path, odd in found.items() if odd is None]
    for start in range(0, len(plain), _MANY):
        some = plain[start : start + _MANY]
        said = under.git("hash-object", "--", *some, doing="look at the files").split()
        found.update(zip(some, said, strict=True))
    return {path: blob or "" for path, blob in found.items()}


def _odd(root: Path, path: str, gone: set[Path]) -> str | None:
    """Return what stands at a path where that is no plain file (which is None): a blob, or zeros for nothing."""
    place = root / path
    for above in (root / p for p in Path(path).parents):
        if above.is_symlink() or above.is_file():
            return _NOTHING if above in gone else _FOLDER  # not where the commit has its folder
    try:
        mode = place.lstat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return _NOTHING
    if stat.S_ISLNK(mode):
        target = os.fsencode(place.readlink())
        return sha1(b"blob %d\0%s" % (len(target), target), usedforsecurity=False).hexdigest()
    if stat.S_ISDIR(mode):
        return _NOTHING if all(p in gone for p in _files_below(place)) else _FOLDER
    return None if stat.S_ISREG(mode) else _FOLDER


def _files_below(folder: Path) -> Iterator[Path]:
    return (p for p in folder.rglob("*") if p.is_symlink() or not p.is_dir())


def _is_so(place: Path, now: str, wish: WantedFile) -> bool:
    if now != wish.blob:
        return False
    return now == _NOTHING or place.is_symlink() or os.access(place, os.X_OK) == (wish.mode == _PROGRAM)


def _refuse(paths: Sequence[str], wanted: Mapping[str, WantedFile]) -> None:
    """Raise PicoError where files would be lost: edits, or what git does not keep."""
    for loose in (True, False):
        some = [p for p in paths if (wanted[p].known == {_NOTHING}) is loose]
        named = ", ".join(some[:3]) + (" and others" if len(some) > 3 else "")
        if some and loose:
            hint = "move it away, or commit it (`git add -f`)"
            raise PicoError(error("exists", f"{named} would be overwritten, and git does not keep it", hint=hint))
        if some:
            hint = "commit the edits (`pico commit`), or shelve them (`pico stash`)"
            raise PicoError(error("dirty", "edits that are not committed would be lost", detail=named, hint=hint))


def _prepare(under: LockedGit, paths: Sequence[str], folder: Path) -> None:
    """Let git write files as the index has them into a folder, and have them on the disk."""
    shutil.rmtree(folder, ignore_errors=True)
    if paths:
        words = ["checkout-index", "-z", "--stdin", "--force", f"--prefix={folder}/"]
        under.git(*words, doing="write the files", stdin="\0".join(paths))
    for path in paths:
        if not (folder / path).is_symlink():
            file = os.open(folder / path, os.O_RDONLY | os.O_CLOEXEC)
            try:
                os.fsync(file)
            finally:
                os.close(file)


def _take_away(root: Path, path: str) -> None:
    """Take a file away, with the folders that are empty then."""
    (root / path).unlink(missing_ok=True)
    _clear(root, (root / path).parent)


def _put(root: Path, path: str, fresh: Path) -> None:
    """Let a file take the place of what is at a path."""
    place = root / path
    place.parent.mkdir(parents=True, exist_ok=True)
    if place.is_dir() and not place.is_symlink():
        _clear(root, place)
    try:
        fresh.replace(place)
    except OSError as exc:
        if exc.errno != errno.EXDEV:
            raise
        beside = place.with_name(f".{place.name}.tmp")  # git's own folder is on another disk
        shutil.copy2(fresh, beside, follow_symlinks=False)
        beside.replace(place)


def _clear(root: Path, folder: Path) -> None:
    """Take away a folder and those above it, as long as they are empty, and not where somebody is."""
    while folder != root and folder != Path.cwd():
        try:
            folder.rmdir()
        except OSError:
            return
        folder = folder.parent
