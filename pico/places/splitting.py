"""Splitting what an earlier PICO kept of all benches of a lab in one folder (`.pico`) into a folder for each bench.

The new folders are built beside (`splitting`) and moved to their places; only the file `benches/layout.json`, written
after that, makes them count. Killed before it, the old layout is still whole and is split anew; killed after it, what
is left of the old one is cleared by whoever comes next.
"""

from __future__ import annotations

import fcntl
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from pico.diagnostics import ExitCode, PicoError, error
from pico.disk import unwritable
from pico.places.lab import BENCHES, FOLDER, refuse_links
from pico.places.layout import EARLIER, GONE, JOURNAL, OLD, UNSORTED, Layout, read_layout, write_layout
from pico.places.old_records import lift_records
from pico.places.sorting import Sorting


def split_layout(root: Path) -> None:
    """Split the old layout of the lab in `root`, or clear what a killed split left of it. Raises PicoError if it can't
    be written, if somebody moves a bench, and for a journal that can't be read."""
    folder = root / FOLDER
    with _alone(folder):
        layout = read_layout(root)
        if layout is None:
            layout = _split(folder)
        elif not layout.clearing:
            if not _entries(folder):
                _clear(folder)
                return
            layout = _set_aside(folder, layout)
        lift_records(root, layout.benches)
        _clear(folder)
        write_layout(folder, layout, clearing=False)


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Be the only one who splits, while no earlier PICO moves or serves a bench."""
    locks = list[int]()
    try:
        for name in ("split.lock", "lock"):
            locks.append(os.open(folder / name, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666))
        fcntl.flock(locks[0], fcntl.LOCK_EX)
        fcntl.flock(locks[1], fcntl.LOCK_EX | fcntl.LOCK_NB)
        if _served(folder):
            raise BlockingIOError
        yield
    except BlockingIOError:
        text = f"an earlier PICO moves or serves a bench of {folder.parent}, whose folders are to be split"
        hint = "wait for its end, or end it (`pico stop`, and `pico edge` or `pico gui` in their terminals)"
        raise PicoError(error("locked", text, hint=hint), ExitCode.LOCKED) from None
    except (OSError, shutil.Error) as exc:
        what = f"{folder} is laid out as by an earlier PICO, and can't be split into a folder for each bench"
        found = unwritable(folder, exc if isinstance(exc, OSError) else OSError(str(exc)), what=what, code="old-layout")
        raise PicoError(found) from exc
    finally:
        for lock in locks:
            os.close(lock)


def _served(folder: Path) -> bool:
    import socket

    try:
        path = json.loads((folder / "edge.json").read_text(encoding="utf-8"))["socket"]
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(path)
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return True


def _split(folder: Path) -> Layout:
    """Build a folder for each bench, move them to their places, and let them count."""
    from pico.places.old_journal import Damaged, benches_of_runs

    building, path = folder / "splitting", folder / JOURNAL
    shutil.rmtree(building, ignore_errors=True)
    try:
        return _built(folder, building, benches_of_runs(path) if path.exists() else {})
    except Damaged as exc:
        text = f"the journal {path} can't be read, so its runs can't be sorted by bench: {exc}"
        hint = f"`mv {path} {path}.damaged` continues without the runs in it that no commit has"
        raise PicoError(error("journal", text, hint=hint)) from exc


def _built(folder: Path, building: Path, runs: Mapping[str, str | None]) -> Layout:
    from pico.places.old_journal import copy_runs

    unclear = tuple(run for run, bench in runs.items() if bench is None)
    sorting = Sorting(folder, building, runs)
    for bench in sorting.benches:
        (building / bench).mkdir(parents=True)
        own = [run for run, of in runs.items() if of == bench]
        if own:
            copy_runs(folder / JOURNAL, building / bench / JOURNAL, own)
    if unclear:
        (building / UNSORTED).mkdir(parents=True)
        copy_runs(folder / JOURNAL, building / UNSORTED / JOURNAL, unclear)
    for path in (*_entries(folder), *sorting.of_plug_ins()):
        refuse_links(path)
        sorting.copy(path)
    _synced(building)
    for name in (*sorting.benches, *((UNSORTED,) if unclear else ())):
        to = folder / name if name == UNSORTED else folder / BENCHES / name
        to.parent.mkdir(exist_ok=True)
        shutil.rmtree(to, ignore_errors=True)  # of a split that was killed before its folders counted
        (building / name).rename(to)
    building.rmdir()
    layout = Layout(sorting.benches, clearing=True, unclear=unclear, told=not unclear)
    write_layout(folder, layout, clearing=True)
    return layout


def _entries(folder: Path) -> list[Path]:
    """Return what the old layout keeps, without what stays in the checkout."""
    known = {*OLD, *GONE, f"{JOURNAL}-wal", f"{JOURNAL}-shm", "gate.sqlite-wal", "gate.sqlite-shm"}
    return sorted(path for path in folder.iterdir() if path.name in known and _counts(path))


def _counts(path: Path) -> bool:
    return path.name != "lock" or path.stat().st_size > 0  # an empty one was made by `_alone`


def _set_aside(folder: Path, layout: Layout) -> Layout:
    """Keep what an earlier PICO wrote after the split: which of it is true of a bench, nobody can tell."""
    number = 1 + sum(path.name.startswith(f"{EARLIER}-") for path in folder.iterdir())
    aside = folder / f"{EARLIER}-{number}"
    aside.mkdir()
    for path in _entries(folder):
        path.rename(aside / path.name)
    return Layout(layout.benches, False, layout.unclear, (*layout.earlier, aside.name), told=False)


def _clear(folder: Path) -> None:
    for path in (*_entries(folder), folder / "lock"):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)


def _synced(folder: Path) -> None:
    """See that all files below a folder, and their names, are on the disk. Raises OSError."""
    for path in (*folder.rglob("*"), folder):
        file = os.open(path, os.O_RDONLY)
        try:
            os.fsync(file)
        finally:
            os.close(file)
