"""The journal of a bench, examined and salvaged: `pico doctor`, `pico doctor --journal`."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from pico.base.state_files import JOURNAL, OWN_LAB, RUN_MARK
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.edge.lease import BenchLock
from pico.history.runs.carrying import carried_runs
from pico.places.bench import BenchPlace
from pico.runs.damage import SALVAGE, FromCommit, from_commit, lost_end, marked_run
from pico.runs.salvage import Examined, Salvage, examine, replace_journal, salvage, write_journal
from pico.runs.storage.change_count import ChangeCount

NAMED = 5
"""So many runs are named one by one."""


@dataclass(frozen=True)
class Salvaged:
    """What becomes of the journal of a bench: `damaged` says whether anything is; `written`, whether the new one is
    in place; `aside` is where the old one now lies, None if it was gone or nothing was changed."""

    bench: str
    path: Path
    damaged: bool
    made: Salvage
    broken: str = ""
    aside: Path | None = None
    written: bool = False


def examine_journal(root: Path, path: Path) -> Iterator[Diagnostic]:
    """Yield what is wrong with a journal of the lab in `root`: damaged rows by run, an error if no commit has it."""
    try:
        found = examine(path)
    except PicoError as exc:
        yield from exc.diagnostics
        return
    if found.broken:
        yield error("journal", f"the journal {path} is damaged: {found.broken}", hint=SALVAGE)
    for run, what in found.damaged().items():
        text = f"run {run} in the journal of the bench {path.parent.name} is damaged ({_some(what)}): {path}"
        if from_commit(path, run) is not None:
            hint = "PICO reads the run from its commit; `pico doctor --journal --yes` writes the journal anew"
            yield warning("journal-record", text, hint=hint)
        else:
            yield error("journal-record", f"{text}; no commit has that run", hint=SALVAGE)


def missing_journal(place: BenchPlace) -> Iterator[Diagnostic]:
    """Yield that a bench has no journal, though it was written to, or though commits hold runs of it. A bench that has
    adopted its Lab has one: both are made when it is taken first."""
    path = JOURNAL.path(place.folder)
    if os.path.lexists(path):
        return
    if least := ChangeCount(path).least():
        yield lost_end(path, f"the file is gone, and it was written to {least} times")
        return
    if not os.path.lexists(OWN_LAB.path(place.folder)):
        return
    try:
        known = carried_runs(place.attached.root, place.title)
    except PicoError:  # a repository or manifests that can't be read, which is told already
        return
    text = f"the bench {place.name} has no journal, and commits hold {len(known)} runs of it: {path}"
    hint = "if it was deleted, `pico doctor --journal --yes` makes a new one of what commits hold"
    yield warning("journal", text, hint=hint)


def salvage_journal(place: BenchPlace, *, write: bool) -> Salvaged:
    """Return what a new journal of a bench would hold, and what would be lost. `write`: put it in the place of the old
    one, which is set aside and never deleted. Raises PicoError, exit code LOCKED if somebody moves the bench."""
    path = JOURNAL.path(place.folder)
    if not write:
        return _salvaged(place, path, examine(path))
    with BenchLock(place).held("pico doctor --journal"):
        found = _salvaged(place, path, examine(path))
        if not found.damaged:
            return found
        new = path.with_name(f".{path.name}.new")
        for old in new.parent.glob(f"{new.name}*"):  # of a command that was killed
            old.unlink()
        write_journal(found.made, new)
        aside = replace_journal(path, new)
        if marked_run(path) in {one.run for one in found.made.lost}:
            RUN_MARK.path(place.folder).unlink(missing_ok=True)
        return Salvaged(found.bench, path, True, found.made, found.broken, aside, written=True)


def _salvaged(place: BenchPlace, path: Path, found: Examined) -> Salvaged:
    known: Callable[[str], FromCommit | None] = lambda run: from_commit(path, run)  # noqa: E731
    committed = carried_runs(place.attached.root, place.title) if found.broken else ()
    made = salvage(found, known, committed)
    return Salvaged(place.name, path, bool(found.broken or found.damaged()), made, found.broken)


def _some(names: list[str]) -> str:
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f"{', '.join(names[:NAMED])}{more}"
