"""The runs that are published with a revision, and their files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from pico.bench.publishing.parts import File, file
from pico.content.store import Store, missing
from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.lab.folder import LabFolder
from pico.history.runs.committed import (
    RunPlace,
    files_at,
    places_at,
    places_folded,
    read_carried,
    runs_added,
)
from pico.history.runs.loading import load_run
from pico.model.trace.run import Artifact, Run
from pico.runs.artifacts import artifact_paths
from pico.runs.files import intact

_SAID = {"run.json": "what the run was", "trace.jsonl": "what it did", "measurements.jsonl": "what it measured"}


def chosen_runs(folder: LabFolder, commit: str, digest: str, names: Sequence[str]) -> list[tuple[Run, RunPlace]]:
    """Return the runs that a commit holds and that are called as in `names`, and where they lie; without names those
    that it added, or that led to the state of the `digest`. Raises PicoError for a name that it has not."""
    repository, damaged = folder.history(), list[Diagnostic]()
    places = places_at(repository, commit, folder.root)
    there = {run.id: run for run in read_carried(repository, places.values(), damaged)}
    if not names:
        added = {run.id for run in runs_added(repository, commit, folder.root)}
        return [(r, places[r.id]) for r in there.values() if r.id in added or r.state_after == digest]
    folded = places_folded(repository, places.values())
    named = {folded[name].id if name in folded else name if name in there else _called(folder, name) for name in names}
    wrong = [_elsewhere(folder, commit, name) for name in sorted(named - there.keys())]
    if wrong:
        raise PicoError((*wrong, *damaged))
    return [(run, places[name]) for name, run in there.items() if name in named]


def _called(folder: LabFolder, word: str) -> str:
    """Return the id of the run that a word begins or ends; raises PicoError where there is none."""
    return load_run(folder, word)[0].document.id


def _elsewhere(folder: LabFolder, commit: str, name: str) -> Diagnostic:
    """Return that a commit does not hold a run, and which does."""
    carries = load_run(folder, name)[1]
    if carries is None:
        hint = "`pico commit` takes it; then this goes"
        return error("unknown-run", f"no commit has the run {name} yet", hint=hint)
    text = f"{carries.short} carries the run {name}, the commit {commit[:7]} does not hold it"
    return error("unknown-run", text, hint=f"`pico runs export {carries.short} --run {name}`")


def files_of(folder: LabFolder, store: Store, chosen: Iterable[tuple[Run, RunPlace]]) -> list[File]:
    """Return the files of runs, their artifacts included; raises PicoError with all that is missing or damaged."""
    wrong: list[Diagnostic] = []
    found: list[File] = []
    for run, place in chosen:
        written = files_at(folder.history(), place)
        damaged: list[Diagnostic] = []
        intact(run, written, damaged)
        wrong += [replace(d, severity="error") for d in damaged]
        wrong += [_missing(store, run, a) for a in run.artifacts if not store.has(a.sha256)]
        found += (file(path, data, _said(path, run)) for path, data in written.items())
        found += _artifacts(run)
    if wrong:
        raise PicoError(wrong)
    return found


def _missing(store: Store, run: Run, artifact: Artifact) -> Diagnostic:
    found = missing(artifact.sha256, store.root)
    return replace(found, summary=f"{artifact.name} of run {run.id} is not here", detail=found.summary)


def _said(path: str, run: Run) -> str:
    return f"{_SAID.get(PurePosixPath(path).name, 'a file')}: run {run.id}"


def _artifacts(run: Run) -> Iterator[File]:
    for path, artifact in artifact_paths(run).items():
        said = f"{artifact.name} of run {run.id}{f': {artifact.component}' if artifact.component else ''}"
        yield File(path=path, name=said, media_type=artifact.media_type, sha256=artifact.sha256, size=artifact.size)
