"""Where a lab lies in Git, and what PICO keeps beside its manifests (`.pico/`)."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from pico.base.state_files import RECORD
from pico.diagnostics import Diagnostic, PicoError, error

FOLDER = ".pico"
BENCHES = "benches"
"""The folder in `.pico` that holds a folder for each bench."""
IGNORE = ".gitignore"
_lenient: list[None] = []
_REPAIR = "`git status` says what is wrong; delete `.git` only if no repository belongs here"


@dataclass(frozen=True)
class LabPlace:
    """Where a lab lies: its folder, that of its worktree, and Git's folder that all worktrees share."""

    root: Path
    top: Path
    common: Path

    @property
    def inside(self) -> str:
        """The lab's folder in the repository."""
        return self.root.relative_to(self.top).as_posix()

    @property
    def record(self) -> Path:
        """The file that says which worktree has which bench."""
        return RECORD.path(self.common / "pico")


def lab_place(root: Path) -> LabPlace | None:
    """Return where a lab lies, None outside Git; without git, for every command asks. Raises PicoError for a `.git`
    that cannot be read, as `git_folders` does."""
    root = Path(os.path.realpath(root))
    found = git_folders(root)
    if found is None:
        return None
    top, _, common = found
    return LabPlace(root, top, common)


def git_folders(path: Path) -> tuple[Path, Path, Path] | None:
    """Return the top of the working tree around `path`, Git's own folder of it, and the one that all worktrees share;
    None if there is no `.git` in `path` or above.

    Raises PicoError for a `.git` that is no repository. That is not the same as none: the folder may be a worktree
    whose link is dead, and its benches are attached elsewhere.
    """
    path = Path(os.path.realpath(path))
    top = next((folder for folder in (path, *path.parents) if os.path.lexists(folder / ".git")), None)
    if top is None:
        return None
    mark = top / ".git"
    try:
        own = mark if mark.is_dir() else top / _text(mark).removeprefix("gitdir:").strip()
        shared = _text(own / "commondir").strip() if os.path.lexists(own / "commondir") else "."
        common = Path(os.path.realpath(own / shared))
        whole = os.path.lexists(own / "HEAD") and all((common / name).is_dir() for name in ("objects", "refs"))
    except (OSError, ValueError) as exc:
        raise PicoError(error("git-unreadable", f"{mark} cannot be read", detail=str(exc), hint=_REPAIR)) from exc
    if whole:
        return top, own, common
    if own == mark:
        raise PicoError(error("git-unreadable", f"Git cannot read the repository at {mark}", hint=_REPAIR))
    text = f"{mark} names {own}, where Git cannot read a repository"
    hint = f"if the repository was moved: `git worktree repair {top}` in it"
    raise PicoError(error("git-unreadable", text, hint=f"{hint}; {_REPAIR}"))


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="surrogateescape")


@contextmanager
def lenient() -> Iterator[None]:
    """Refuse no symbolic links in `.pico` meanwhile, and take a record of benches that can't be read for an empty one,
    which is never written: for commands that only make a bench safer. The worktree where they are called then counts as
    that of the bench, or the main one if it used it."""
    _lenient.append(None)
    try:
        yield
    finally:
        _lenient.pop()


def is_lenient() -> bool:
    """Return whether somebody makes a bench safer, see `lenient`."""
    return bool(_lenient)


def own_folder(root: Path) -> Path:
    """Return what PICO keeps beside the manifests in `root`; raises PicoError for a link in it.

    PICO makes none there: a commit of somebody else brought it, and what PICO writes would go where it points.
    """
    own_names(root)
    return root / FOLDER


def own_names(root: Path) -> frozenset[str]:
    """Return what lies directly in `.pico` of the lab in `root`, and see that Git leaves it alone. Raises PicoError as
    `own_folder` does."""
    names = refuse_links(root / FOLDER)
    if names and IGNORE not in names:
        _ignore(root / FOLDER)
    return names


def make_own_folder(root: Path) -> Path:
    """Make the folder in which PICO keeps what it knows, for Git to leave alone, and return it. Raises OSError,
    PicoError."""
    folder = own_folder(root)
    folder.mkdir(parents=True, exist_ok=True)
    _ignore(folder)
    return folder


def _ignore(folder: Path) -> None:
    """Let Git leave a folder alone, also in `git add -A`, `git stash -u` and `git clean -fd`."""
    with suppress(OSError):  # on a read-only disk Git changes nothing, either
        if not (folder / IGNORE).exists():
            (folder / IGNORE).write_text("*\n", encoding="ascii")


def refuse_links(folder: Path) -> frozenset[str]:
    """Return the names in a folder, none if there is no such folder. Raises PicoError if it, or what lies directly in
    it, is a symbolic link, but while `lenient`: light is ended however the folder looks."""
    if folder.is_symlink() and not _lenient:
        raise PicoError(_link(folder))
    try:
        with os.scandir(folder) as found:
            entries = list(found)
    except OSError:
        return frozenset()
    for entry in entries:
        if entry.is_symlink() and not _lenient:
            raise PicoError(_link(Path(entry.path)))
    return frozenset(entry.name for entry in entries)


def _link(path: Path) -> Diagnostic:
    text = f"{path} is a symbolic link, and PICO would write where it points"
    return error(
        "symlink", text, hint=f"delete it: `rm {shlex.quote(str(path))}`; what PICO keeps there it makes itself"
    )
