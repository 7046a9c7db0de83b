"""Every file below `.pico`, and those in Git's own folder, looked at as their readers would."""

from __future__ import annotations

import errno
import os
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from pico.backends.sim.store import world_from_json
from pico.base import state_files
from pico.base.plain_files import other_than_file
from pico.base.state_file import StateFile, quoted
from pico.base.state_files import files_below, files_in_git
from pico.bench.mending.journal import examine_journal, missing_journal
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.edge import armings, dose, own_lab, terms_store
from pico.edge.network.enrolment import read_enrolment
from pico.edge.network.remotes import known as known_remotes
from pico.edge.recovery import lost_table
from pico.places.bench import BenchPlace, local_benches
from pico.places.choice import read_choice
from pico.places.lab import lab_place
from pico.places.layout import read_layout
from pico.places.record import read_record
from pico.places.seals import sealed_labs


def damaged_files(root: Path, read_log: Callable[[Path], object]) -> tuple[Diagnostic, ...]:
    """Return what is wrong with the files that PICO keeps of the lab in `root`, each named with its path, what is lost
    with it and what to do; what PICO mends itself is a warning. `read_log`: reads what a run of a recipe has done, and
    raises PicoError."""
    found = dict[str, Diagnostic]()
    lab = lab_place(root)
    in_git = ((p, n, e) for p, n, e in (files_in_git(lab.common) if lab else ()) if other_than_file(p))
    for path, name, entry in (*files_below(root), *in_git):
        for one in _of_recipe(path, read_log) if entry is state_files.RECIPE_LOG else _of_file(root, path, name, entry):
            found.setdefault(f"{path}{one.summary}", one)
    for one in _as_read(root):
        if not any(one.summary == known.summary or _is_link_of(known, one) for known in found.values()):
            found[one.summary] = one
    return tuple(found.values())


def _is_link_of(known: Diagnostic, one: Diagnostic) -> bool:
    """Return whether a file that a reader cannot read is a link that is reported already."""
    return known.code == "symlink" and known.summary.split(" is ")[0] == one.summary.split(" cannot be read")[0]


def _of_file(root: Path, path: Path, name: str, entry: StateFile | None) -> Iterator[Diagnostic]:
    if path.name.startswith(".") and ".tmp" in path.name:  # of a process that was killed; the next lock clears it
        return
    if entry is state_files.DAMAGED:  # it was set aside, whatever it is
        return
    if path.is_symlink():
        text = f"{path} is a symbolic link, and PICO would write where it points"
        yield error("symlink", text, hint=f"delete it: `rm {quoted(path)}`")
    elif (what := other_than_file(path)) and entry is not None:
        yield entry.unreadable(path, f"it is {what}")
    elif not what and not os.access(path, os.R_OK):
        yield (entry or state_files.DAMAGED).unreadable(path, os.strerror(errno.EACCES))
    elif entry is None:
        text = f"{path} is not one of the files that PICO keeps there"
        yield warning("state-unknown", text, hint=f"look at it; `rm {quoted(path)}` if it is not yours")
    elif entry is state_files.JOURNAL:
        if path.name == entry.name:  # what SQLite has beside it is read with it
            yield from examine_journal(root, path)
    elif entry is state_files.GATE:
        if path.name == entry.name and (why := _wrong_database(path)):
            yield entry.damaged(path, why)
    elif not entry.text:
        make: Callable[..., object] = world_from_json if entry is state_files.WORLD else dict
        if (wrong := entry.wrong(path, make)) is not None:
            mends = entry.is_expendable or entry.kind == "memory"
            yield replace(wrong, severity="warning", hint="PICO makes it anew") if mends else wrong


def _of_recipe(path: Path, read_log: Callable[[Path], object]) -> Iterator[Diagnostic]:
    try:
        read_log(path)
    except PicoError as exc:
        yield from exc.diagnostics


def _wrong_database(path: Path) -> str:
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as db:
            said = str(db.execute("PRAGMA integrity_check(1)").fetchone()[0])
    except sqlite3.Error as exc:
        return str(exc)
    return "" if said == "ok" else said


def _as_read(root: Path) -> Iterator[Diagnostic]:
    """Yield what readers say who compare several files: the Lab of a bench and its seal, armings, Git's own folder."""
    lab = lab_place(root)
    asked: list[Callable[[], object]] = [lambda: read_choice(root), lambda: read_layout(root)]
    if lab is not None:
        asked += [lambda: read_record(lab), lambda: sealed_labs(lab), lambda: known_remotes(root)]
    for place in _benches(root):
        asked += [lambda at=place: own_lab.read(at), lambda at=place: dose.read(at)]  # type: ignore[misc]
        asked += [lambda at=place: read_enrolment(at)]  # type: ignore[misc]
        yield from missing_journal(place)
        yield from (one for one in (terms_store.missing(place), lost_table(place)) if one is not None)
        for one in armings.kept(place):
            if one.broken:
                path = place.folder / armings.FOLDER / f"{one.laser}.json"
                yield replace(state_files.ARMED.damaged(path, one.broken), address=one.laser)
    for ask in asked:
        try:
            ask()
        except PicoError as exc:
            yield from exc.diagnostics


def _benches(root: Path) -> tuple[BenchPlace, ...]:
    try:
        return local_benches(root)
    except PicoError:  # a link or an old layout, which is told already
        return ()
