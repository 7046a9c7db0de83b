"""Which worktree has the bench of a lab: one is attached to it, the others of the same repository only look and plan.

What PICO keeps of a bench (the simulated table, the journal, locks) is in `.pico` beside the manifests of the attached
worktree. Which one that is stands in `pico/bench.json` of the folder that all worktrees of a repository share, by the
lab's folder in it. The first that moves something is attached; `attach` takes the bench to another one. Separate clones
and labs outside Git have a bench each.
"""

from __future__ import annotations

import fcntl
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.disk import write_whole, writing

FOLDER = ".pico"
RECORD = "bench.json"
_held: dict[Path, Path] = {}
_STAYS = ("write.lock", "write.tmp", "holder.json", "incoming", "replaced")
"""What is not the bench: locks of writers, scratch files, what `_bring` makes."""


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
        return self.common / "pico" / RECORD


def bench_folder(root: Path) -> Path:
    """Return where the bench of the lab in folder `root` is kept: `.pico` of the worktree that is attached to it.

    Raises PicoError where that is a link, for PICO writes there.
    """
    if (held := _held.get(root)) is not None:
        return held
    place = lab_place(root)
    return own_folder((place and attached(place)) or root)


def hold(root: Path) -> None:
    """Take the place of the bench of the lab in `root` as it is until `let_go`: who has the bench locked need not look
    for it again, for nobody takes it elsewhere meanwhile. Raises PicoError as `bench_folder` does."""
    _held[root] = bench_folder(root)


def let_go(root: Path) -> None:
    """Look for the place of a bench again each time, see `hold`."""
    _held.pop(root, None)


def own_folder(root: Path) -> Path:
    """Return what PICO keeps beside the manifests in `root`; raises PicoError for a link in it.

    PICO makes none there: a commit of somebody else brought it, and what PICO writes would go where it points.
    """
    folder = root / FOLDER
    for path in (folder, folder / "sim", folder / "hardware", folder / "emulated"):
        for link in (path, *_links(path)):
            if link.is_symlink():
                text = f"{link} is a symbolic link, and PICO would write where it points"
                raise PicoError(error("symlink", text, hint="delete it; what PICO keeps there it makes itself"))
    return folder


def _links(folder: Path) -> list[Path]:
    try:
        with os.scandir(folder) as found:
            return [Path(entry.path) for entry in found if entry.is_symlink()]
    except OSError:
        return []


def require_attached(root: Path) -> None:
    """Attach the worktree of the lab in `root` to its bench where none is; raises PicoError (exit code LOCKED) where
    another one is. Call it with the bench locked, before something moves."""
    place = lab_place(root)
    if place is None or not any(root.glob("*.yaml")):  # a scratch folder is no lab
        return
    with _recording(place) as record:
        there = _told(place, record)
        if there is None:
            record[place.inside] = os.path.relpath(place.root, place.common)
        elif there != place.root:
            raise PicoError(_elsewhere(there, gone=not _is_of(there, place)), ExitCode.LOCKED)


def attached(place: LabPlace) -> Path | None:
    """Return the folder of the lab in the worktree that has the bench; None where no worktree that is there has it."""
    there = _told(place, _read(place.record))
    return there if there is not None and _is_of(there, place) else None


def attach(root: Path) -> Path | None:
    """Attach the worktree of the lab in `root` to its bench, which moves there with its simulated table and journal.

    Call it with the bench locked where it was. Returns the folder that had it until now; None where there was none, or
    where that is gone with all that it kept. Raises PicoError outside a repository, and where files can't be moved.
    """
    place = lab_place(root)
    if place is None:
        hint = "outside Git each folder has a bench of its own"
        raise PicoError(error("git-none", f"{root} is in no Git repository, so there is nothing to attach", hint=hint))
    with _recording(place) as record:
        before = _told(place, record)
        there = before if before != place.root and before is not None and _is_of(before, place) else None
        if there is not None:
            _bring(own_folder(there), own_folder(place.root))
        record[place.inside] = os.path.relpath(place.root, place.common)
    if there is not None:
        _clear(own_folder(there))
    return there


def lab_place(root: Path) -> LabPlace | None:
    """Return where a lab lies, None outside Git; without git, for every command asks."""
    root = Path(os.path.realpath(root))
    for top in (root, *root.parents):
        mark = top / ".git"
        try:
            own = mark if mark.is_dir() else (top / mark.read_text().removeprefix("gitdir:").strip())
        except (OSError, ValueError):
            continue
        try:
            shared = (own / "commondir").read_text().strip()
        except (OSError, ValueError):
            shared = "."
        common = Path(os.path.realpath(own / shared))
        return LabPlace(root, top, common) if (common / "objects").is_dir() else None
    return None


def _told(place: LabPlace, record: Mapping[str, str]) -> Path | None:
    """Return which folder the record names; the main worktree where it names none and that has a bench already."""
    if place.inside in record:
        return Path(os.path.normpath(place.common / record[place.inside]))
    main = place.common.parent / place.inside
    return main if place.common.name == ".git" and (main / FOLDER / "lock").exists() else None


def _is_of(folder: Path, place: LabPlace) -> bool:
    """Return whether a folder still is this lab in a worktree of the same repository."""
    found = lab_place(folder) if folder.is_dir() else None
    return found is not None and (found.common, found.inside) == (place.common, place.inside)


@contextmanager
def _recording(place: LabPlace) -> Iterator[dict[str, str]]:
    """Read the record, and write it where it was changed; nobody else does so meanwhile."""
    path = place.record
    with writing(path, code="folder"):
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = os.open(path.with_suffix(".lock"), os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        record = _read(path)
        before = dict(record)
        yield record
        if record != before:
            write_whole(path, (json.dumps(record, indent=2, sort_keys=True) + "\n").encode(), code="folder")
    finally:
        os.close(lock)


def _read(path: Path) -> dict[str, str]:
    """Return the record; one that can't be read names nothing."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return {key: value for key, value in found.items() if isinstance(value, str)}
    except (OSError, ValueError, AttributeError):
        return {}


def _bring(there: Path, here: Path) -> None:
    """Copy what one worktree keeps of the bench into another one; whole, or its own stays."""
    incoming = here / "incoming"
    try:
        shutil.rmtree(incoming, ignore_errors=True)
        here.mkdir(parents=True, exist_ok=True)
        skipped = shutil.ignore_patterns(*_STAYS)
        shutil.copytree(there, incoming, ignore=skipped, symlinks=True)
        _set_aside(here)
        for new in sorted(incoming.iterdir()):
            new.replace(here / new.name)
        incoming.rmdir()
    except (OSError, shutil.Error) as exc:
        text = f"the bench in {there} could not be brought to {here}: {exc}"
        raise PicoError(error("attach", text, hint="it is attached to the worktree where it was")) from exc


def _set_aside(here: Path) -> None:
    """Keep what a worktree had of a bench of its own before, in `replaced`; nobody reads it."""
    if old := _kept(here):
        shutil.rmtree(here / "replaced", ignore_errors=True)
        (here / "replaced").mkdir()
        for path in old:
            path.replace(here / "replaced" / path.name)


def _clear(folder: Path) -> None:
    """Take away what was brought elsewhere; what stays is not read any more."""
    for old in _kept(folder):
        _discard(old)


def _kept(folder: Path) -> list[Path]:
    return [path for path in folder.iterdir() if path.name not in _STAYS] if folder.is_dir() else []


def _discard(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)


def _elsewhere(there: Path, *, gone: bool) -> Diagnostic:
    if gone:
        text = f"the bench was attached to {there}, which is gone, with its simulated table and journal"
        return error("not-attached", text, hint="`pico git attach` takes it: every part then stands at home")
    hint = f"work there (`pico -C {there} ...`), or bring the bench here: `pico git attach`; looking is always possible"
    return error("not-attached", f"this worktree only plans: the bench is attached to {there}", hint=hint)
