"""One run with everything that is known of it."""

from __future__ import annotations

import os
import zlib
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from difflib import get_close_matches

from pico.content.store import Store, store_in, store_of
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.history.git.commit import Commit
from pico.history.lab.folder import LabFolder
from pico.history.runs.benches import refuse_of_another
from pico.history.runs.committed import (
    RunPlace,
    files_at,
    places_added,
    places_folded,
    places_in_history,
    read_carried,
    read_place,
)
from pico.history.runs.uncommitted import of_others, unrecorded
from pico.model.setup import Setup
from pico.model.state import LabState
from pico.model.trace.run import Run, TraceEvent
from pico.runs.document import RecordedRun
from pico.runs.files import MEASUREMENTS, TRACE, intact, run_folder
from pico.runs.folding import unfolded
from pico.runs.reading import read_events
from pico.runs.states import state_seen

A_SLIP = 0.95
"""So much alike are ids that differ by a slip; those of one day are not far from it, whichever run they are of."""
LARGEST = 256 << 20
"""Bytes above which no packed file of a run is unpacked."""


def load_run(folder: LabFolder, word: str | None = None) -> tuple[RecordedRun, Commit | None]:
    """Return the run whose id begins or ends with `word`, the last one where None; and the commit that carries it, None
    where none does yet.

    Raises PicoError for one that there is not, for a word that fits several, and for a document that is damaged.
    """
    run, commit = _loaded(folder, word)
    store, wanted = store_of(folder.root), {a.sha256 for a in run.document.artifacts}
    stored = {one: os.path.relpath(store.path(one), folder.root) for one in wanted if store.has(one)}
    return replace(run, stored=stored, missing=frozenset(wanted - stored.keys())), commit


def load_runs(folder: LabFolder, names: Collection[str], diagnostics: list[Diagnostic]) -> tuple[RecordedRun, ...]:
    """Return the runs of these ids, in their order; what is wrong with their files is appended to `diagnostics`, and
    those that can't be read are left out."""
    own = {run.document.id: run for run in unrecorded(folder, diagnostics)}
    places = places_in_history(folder.repository, folder.root) if folder.repository else {}
    found = []
    for name in names:
        wrong: list[Diagnostic] = []
        try:
            if name in own:
                found.append(own[name])
            else:  # one that is folded into another has no place of its own
                found.append(_carried(folder, places[name], wrong)[0] if name in places else _loaded(folder, name)[0])
        except PicoError as exc:
            wrong += exc.diagnostics
        diagnostics += wrong
    return tuple(found)


def runs_in(folder: LabFolder, commit: str) -> tuple[RecordedRun, ...]:
    """Return the runs that a commit (its id) brought, in the order in which they started; what can't be read is left
    out."""
    found = []
    for place in places_added(folder.history(), commit, folder.root):
        with suppress(PicoError):
            found.append(_carried(folder, place, [])[0])
    return tuple(sorted(found, key=lambda run: run.document.order))


def _loaded(folder: LabFolder, word: str | None) -> tuple[RecordedRun, Commit | None]:
    wrong: list[Diagnostic] = []
    own = {run.document.id: run for run in unrecorded(folder, wrong)}
    places = places_in_history(folder.repository, folder.root) if folder.repository else {}
    if word is None:
        name = _last(folder, own, places)
        return (own[name], None) if name in own else _carried(folder, places[name], wrong)
    folded = places_folded(folder.history(), places.values()) if places else {}
    known = sorted({*own, *places})
    if not _fitting(word, known) and (there := {run.document.id: run for run in of_others(folder, word, wrong)}):
        return there[_chosen(word, sorted(there), ())], None
    try:
        name = _chosen(word, known, sorted(folded))
    except PicoError:
        refuse_of_another(folder.place, word, f"runs show {word}")
        raise
    if name in own:
        return own[name], None
    return _carried(folder, places[name], wrong) if name in places else _member(folder, name, folded[name], wrong)


def carried_at(folder: LabFolder, place: RunPlace) -> RecordedRun:
    """Return the run that a commit has at a place; raises PicoError for a document that is damaged."""
    return _carried(folder, place, [])[0]


def member_at(folder: LabFolder, name: str, place: RunPlace) -> RecordedRun:
    """Return a run as it was before it was folded into the one at a place; raises PicoError as `carried_at` does."""
    return _member(folder, name, place, [])[0]


def _member(folder: LabFolder, name: str, place: RunPlace, wrong: list[Diagnostic]) -> tuple[RecordedRun, Commit]:
    """Return a run as it was before it was folded into the one at a place."""
    whole, commit = _carried(folder, place, wrong)
    for run in unfolded(whole):
        if run.document.id == name:
            return replace(run, after=_after(folder.setup, run.measurements)), commit
    raise PicoError(error("run-file", f"{place.path}/run.json names the run {name}, and what it says of it is damaged"))


def _last(folder: LabFolder, own: Mapping[str, RecordedRun], places: Mapping[str, RunPlace]) -> str:
    """Return the run that started last; what no commit has yet comes after what commits have."""
    if own:
        return list(own)[-1]
    if not places:
        raise PicoError(error("no-run", "no run of this lab has moved anything yet", hint="`pico apply` runs a plan"))
    day = max(places)[:8]  # a name begins with the time
    late = read_carried(folder.history(), (place for name, place in places.items() if name >= day))
    return late[-1].id if late else max(places)


def _chosen(word: str, names: Sequence[str], folded: Sequence[str]) -> str:
    """Return the one name that a word is, begins, or ends: tables show the last six characters. Those that are `folded`
    into others count where the word fits nothing else."""
    if word in names or word in folded:
        return word
    found = _fitting(word, names) or _fitting(word, folded)
    if len(found) == 1:
        return found[0]
    if found:
        some = ", ".join(f"`{name}`" for name in found[:4])
        raise PicoError(error("run", f"{len(found)} runs begin or end with `{word}`", hint=f"write more of it: {some}"))
    inside = [name for name in names if word and word in name] or get_close_matches(word, names, cutoff=A_SLIP)[:1]
    hint = f"did you mean `{inside[-1]}`?" if inside else "`pico runs list --all` shows them"
    raise PicoError(error("run", f"there is no run `{word[:60]}`", hint=hint))


def _fitting(word: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(word) or (word and name.endswith(f"-{word}"))]


def _carried(folder: LabFolder, place: RunPlace, wrong: list[Diagnostic]) -> tuple[RecordedRun, Commit]:
    repository = folder.history()
    document = read_place(repository, place)
    if isinstance(document, Diagnostic):
        raise PicoError(error(document.code, document.summary, detail=document.detail, hint=document.hint))
    store = store_in(repository.common)
    files = files_at(repository, place)
    intact(document, files, wrong)
    trace, measurements = (_events(document, files, store, name, wrong) for name in (TRACE, MEASUREMENTS))
    run = RecordedRun(
        document=document,
        after=_after(folder.setup, measurements),
        trace=trace,
        measurements=measurements,
        diagnostics=tuple(wrong),
    )
    return run, repository.commits([place.commit])[place.commit]


def _after(setup: Setup, measurements: Iterable[TraceEvent]) -> LabState | None:
    """Return the bench as it was observed after a run; None where nobody looked, or what was seen is not here."""
    seen = {e.component: e.data for e in measurements if e.kind == "observation" and e.component}
    try:
        return state_seen(setup, seen) if seen else None
    except (KeyError, TypeError, ValueError):  # written by another program
        return None


def _events(
    document: Run, files: Mapping[str, bytes], store: Store, name: str, wrong: list[Diagnostic]
) -> tuple[TraceEvent, ...]:
    """Return the events of a file of a run, from the commit or from the content store."""
    path = f"{run_folder(document)}/{name}"
    if path in files:
        return read_events(path, files[path], wrong)
    packed = next((a for a in document.artifacts if a.name == f"{name}.gz"), None)
    if packed is None:
        return ()
    try:
        return read_events(path, _unpacked(store.get(packed.sha256)), wrong)
    except PicoError as exc:
        wrong += [warning(d.code, f"{path}.gz: {d.summary}", hint=d.hint) for d in exc.diagnostics]
    except zlib.error:
        wrong.append(warning("run-file", f"{path}.gz can't be unpacked"))
    return ()


def _unpacked(data: bytes) -> bytes:
    return zlib.decompressobj(wbits=zlib.MAX_WBITS | 16).decompress(data, LARGEST)
