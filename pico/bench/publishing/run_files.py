"""The runs that are published with a revision, and their files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from pico.bench.publishing.parts import File, PublishedRun, file
from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.history.lab.folder import LabFolder
from pico.history.runs.committed import CarriedRun, files_at, runs_added, runs_at
from pico.model.run import Artifact, RunDocument
from pico.runs.artifacts import artifact_paths
from pico.runs.files import intact, run_folder
from pico.runs.store import Store, missing

_SAID = {"run.json": "what the run was", "trace.jsonl": "what it did", "measurements.jsonl": "what it measured"}


def chosen_runs(folder: LabFolder, commit: str, digest: str, names: Sequence[str]) -> tuple[CarriedRun, ...]:
    """Return the runs that a commit holds and that are called as in `names`; without names those that it added, or that
    led to the state of the `digest`. Raises PicoError for a name that it has not."""
    repository, damaged = folder.history(), list[Diagnostic]()
    there = {run.document.id: run for run in runs_at(repository, commit, folder.root, damaged)}
    if not names:
        added = {run.id for run in runs_added(repository, commit, folder.root)}
        return tuple(r for r in there.values() if r.document.id in added or r.document.state_after == digest)
    unknown = [name for name in names if name not in there]
    if unknown:
        hint = did_you_mean(unknown[0], there) or "`pico runs list` shows the runs"
        text = f"the commit {commit[:7]} holds no run {', '.join(unknown)}"
        raise PicoError((error("unknown-run", text, hint=hint), *damaged))
    return tuple(run for name, run in there.items() if name in names)


def published_runs(
    folder: LabFolder, store: Store, chosen: Iterable[CarriedRun]
) -> list[tuple[PublishedRun, tuple[File, ...]]]:
    """Return the files of each run, its artifacts included; raises PicoError with all that is missing or damaged."""
    wrong: list[Diagnostic] = []
    found = []
    for run in chosen:
        written = files_at(folder.history(), run.place) if run.place else {}
        damaged: list[Diagnostic] = []
        intact(run.document, written, damaged)
        wrong += [replace(d, severity="error") for d in damaged]
        wrong += [_missing(store, run.document, a) for a in run.document.artifacts if not store.has(a.sha256)]
        beside = (file(path, data, _said(path, run.document)) for path, data in sorted(written.items()))
        files = (*beside, *_artifacts(run.document))
        at, paths = run_folder(run.document), tuple(f.path for f in files)
        found.append((PublishedRun(document=run.document, folder=at, files=paths), files))
    if wrong:
        raise PicoError(wrong)
    return found


def _missing(store: Store, run: RunDocument, artifact: Artifact) -> Diagnostic:
    found = missing(artifact.sha256, store.root)
    return replace(found, summary=f"{artifact.name} of run {run.id} is not here", detail=found.summary)


def _said(path: str, run: RunDocument) -> str:
    return f"{_SAID.get(PurePosixPath(path).name, 'a file')}: run {run.id}"


def _artifacts(run: RunDocument) -> Iterator[File]:
    for path, artifact in artifact_paths(run).items():
        said = f"{artifact.name} of run {run.id}{f': {artifact.component}' if artifact.component else ''}"
        yield File(path=path, name=said, media_type=artifact.media_type, sha256=artifact.sha256, size=artifact.size)
