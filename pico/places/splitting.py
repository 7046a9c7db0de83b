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
import socket
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.disk import unwritable, write_whole
from pico.places.lab import BENCHES, FOLDER, refuse_links
from pico.places.old_journal import benches_of_runs, copy_runs
from pico.places.old_records import lift_records

JOURNAL = "journal.sqlite"
LAYOUT = "layout.json"
SCHEMA = "pico.benches-layout/v1"
UNSORTED = "unsorted"
EARLIER = "earlier"
_DEVICES = ("sim", "emulated", "hardware")
_ALL = ("lab.json", "lock", "dose.json")
"""Files that each bench gets: its Lab, its last token, and how much light samples had, which must not be forgotten."""
_OF_RUNS = ("run", "points", "recipes")
"""What names a run, and goes with that."""
_OF_SIM = ("seen.json", "hands.json")
_OF_LAST = ("enrolment.json", "gate.sqlite", "unattended.json")
_GONE = ("edge.json", "stop.json", "unattended.lock", "holder.json", "incoming")
"""What counts only while a process lives."""
OLD = frozenset({
    *_ALL, *_OF_RUNS, *_OF_SIM, *_OF_LAST, *_DEVICES, JOURNAL, "armed", "mornings.json", "edge.json", "stop.json",
})  # fmt: skip
"""Names in `.pico` that tell of the old layout."""


@dataclass(frozen=True)
class Layout:
    """What was done with the old layout."""

    benches: tuple[str, ...] = ()
    """The benches that it was split into."""
    clearing: bool = False
    """Whether what is left of it has still to be cleared."""
    unclear: tuple[str, ...] = ()
    """The runs whose bench is unclear; they are in `UNSORTED`."""
    earlier: tuple[str, ...] = ()
    """Folders below `.pico` with what an earlier PICO wrote after the split."""
    told: bool = True
    """Whether a person was told of these."""


def split_if_old(root: Path, names: frozenset[str]) -> None:
    """Split the old layout of the lab in `root`, whose `.pico` has entries of these names, if it is one. Raises
    PicoError if it can't be written, if somebody moves a bench, and for a journal that can't be read."""
    if not names & OLD:
        return
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
        _write_layout(folder, layout, clearing=False)


def read_layout(root: Path) -> Layout | None:
    """Return what was done with the old layout of the lab in `root`; None if nothing was."""
    try:
        found = json.loads((root / FOLDER / BENCHES / LAYOUT).read_text(encoding="utf-8"))
        return Layout(
            tuple(found["benches"]), bool(found["clearing"]), tuple(found["unclear"]), tuple(found["earlier"]),
            bool(found["told"]),
        )  # fmt: skip
    except (OSError, ValueError, KeyError, TypeError):
        return None


def take_report(root: Path) -> tuple[Diagnostic, ...]:
    """Return, once, what a split could not sort."""
    layout = read_layout(root)
    if layout is None or layout.told:
        return ()
    folder = root / FOLDER
    with suppress(PicoError):  # on a read-only disk it is told again
        _write_layout(folder, layout, clearing=layout.clearing, told=True)
    found = []
    if layout.unclear:
        text = f"it is unclear on which bench these runs were: {', '.join(layout.unclear)}"
        hint = f"they are kept in {folder / UNSORTED / JOURNAL}, and no bench of this lab counts them"
        found.append(warning("unsorted-runs", text, hint=hint))
    for name in layout.earlier:
        text = f"an earlier PICO moved benches of this lab since each has a folder of its own: see {folder / name}"
        hint = "look at what stands on the table (`pico status`) before you move it, and update that PICO"
        found.append(warning("earlier-layout", text, hint=hint))
    return tuple(found)


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
    except sqlite3.Error as exc:
        path = folder / JOURNAL
        text = f"the journal {path} can't be read, so its runs can't be sorted by bench: {exc}"
        hint = f"`mv {path} {path}.broken` goes on without the runs in it that no commit has"
        raise PicoError(error("journal", text, hint=hint)) from exc
    finally:
        for lock in locks:
            os.close(lock)


def _served(folder: Path) -> bool:
    try:
        path = json.loads((folder / "edge.json").read_text(encoding="utf-8"))["socket"]
        with socket.socket(socket.AF_UNIX) as link:
            link.connect(path)
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return True


def _split(folder: Path) -> Layout:
    """Build a folder for each bench, move them to their places, and let them count."""
    building = folder / "splitting"
    shutil.rmtree(building, ignore_errors=True)
    runs = benches_of_runs(folder / JOURNAL) if (folder / JOURNAL).exists() else {}
    unclear = tuple(run for run, bench in runs.items() if bench is None)
    sorting = _Sorting(folder, building, runs)
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
    _write_layout(folder, layout, clearing=True)
    return layout


@dataclass
class _Sorting:
    """Where each entry of the old layout belongs."""

    folder: Path
    building: Path
    runs: Mapping[str, str | None]
    benches: tuple[str, ...] = field(init=False)
    last: str = field(init=False)

    def __post_init__(self) -> None:
        worlds = [name for name in _DEVICES if (self.folder / name).is_dir()]
        known = [bench for bench in self.runs.values() if bench is not None]
        self.last = known[-1] if known else worlds[0] if len(worlds) == 1 else _DEVICES[0]
        self.benches = tuple(dict.fromkeys([*known, *worlds, self.last]))

    def of_plug_ins(self) -> list[Path]:
        """Return the folders of devices of plug-ins that had runs; they stay there, too."""
        return [self.folder / name for name in self.benches if name not in _DEVICES and (self.folder / name).is_dir()]

    def copy(self, path: Path) -> None:
        """Copy one entry to the bench, or the benches, that it belongs to. Raises OSError."""
        name = path.name
        if name in self.benches:
            _copied(path, self.building / name, inside=True)
        elif name in _ALL:
            for bench in self.benches:
                _copied(path, self.building / bench / name)
        elif name in ("points", "recipes"):
            for one in sorted(path.iterdir()):
                _copied(one, self._of(one) / name / one.name)
        elif name == "armed":
            for one in sorted(path.glob("*.json")):
                _copied(one, self.building / self._armed(one) / name / one.name)
        elif name == "run":
            _copied(path, self._of(path) / name)
        elif name == "mornings.json":
            self._mornings(path)
        elif name in _OF_SIM:
            self._into(_DEVICES[0], path)
        elif name not in (JOURNAL, f"{JOURNAL}-wal", f"{JOURNAL}-shm", *_GONE):
            self._into(self.last, path)

    def _into(self, bench: str, path: Path) -> None:
        _copied(path, self.building / (bench if bench in self.benches else self.last) / path.name)

    def _of(self, path: Path) -> Path:
        """Return the folder of the bench whose run a file names, by its own name or in it."""
        beside = path.with_suffix(".jsonl") if path.suffix in (".out", ".pid") else path
        text = f"{path.name}\n{beside.read_text(encoding='utf-8', errors='replace') if beside.is_file() else ''}"
        named = [bench or UNSORTED for run, bench in self.runs.items() if run in text]
        return self.building / (named[-1] if named else self.last)

    def _armed(self, path: Path) -> str:
        try:
            bench = str(json.loads(path.read_text(encoding="utf-8"))["backend"])
        except (OSError, ValueError, KeyError, TypeError):
            bench = self.last
        return bench if bench in self.benches else self.last

    def _mornings(self, path: Path) -> None:
        """Give each bench the references that its own runs are."""
        try:
            document = json.loads(path.read_text(encoding="utf-8"))
            of = [self.runs.get(one["run"]) or self.last for one in document["references"]]
        except (OSError, ValueError, KeyError, TypeError):
            self._into(self.last, path)
            return
        for bench in dict.fromkeys(of):
            own = [one for one, at in zip(document["references"], of, strict=True) if at == bench]
            data = json.dumps({**document, "references": own}, sort_keys=True).encode()
            write_whole(self.building / bench / path.name, data)


def _entries(folder: Path) -> list[Path]:
    """Return what the old layout keeps, without what stays in the checkout."""
    known = {*OLD, *_GONE, f"{JOURNAL}-wal", f"{JOURNAL}-shm", "gate.sqlite-wal", "gate.sqlite-shm"}
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


def _copied(path: Path, to: Path, *, inside: bool = False) -> None:
    to.parent.mkdir(parents=True, exist_ok=True)
    if path.is_dir():
        shutil.copytree(path, to, dirs_exist_ok=inside)
    else:
        shutil.copy2(path, to)


def _synced(folder: Path) -> None:
    """See that all files below a folder, and their names, are on the disk. Raises OSError."""
    for path in (*folder.rglob("*"), folder):
        file = os.open(path, os.O_RDONLY)
        try:
            os.fsync(file)
        finally:
            os.close(file)


def _write_layout(folder: Path, layout: Layout, *, clearing: bool, told: bool | None = None) -> None:
    document = {
        "schema": SCHEMA, "benches": layout.benches, "clearing": clearing, "unclear": layout.unclear,
        "earlier": layout.earlier, "told": layout.told if told is None else told,
    }  # fmt: skip
    write_whole(folder / BENCHES / LAYOUT, (json.dumps(document, indent=1) + "\n").encode(), folders=True)
