"""Collects what is published of a revision: from its commit, from the store, and what is computed from its state."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from pico.bench.publishing.computed import pictures_of, plan_between, states, types
from pico.bench.publishing.parts import File, Revision, file
from pico.bench.publishing.run_files import chosen_runs, files_of
from pico.content.store import Store
from pico.diagnostics import PicoError
from pico.history.lab.folder import LabFolder
from pico.model.setup import Setup
from pico.model.state import LabState, home_state
from pico.model.trace.run import STRENGTH, Run

_BESIDE = re.compile(
    r"(?:README|LICEN[SC]E|COPYING|CITATION)(?:\.[a-z]+)?|calibration\.json|calibration/[a-z_]+\.json|notes/[^/]+\.md"
)
_LICENSE = re.compile(r"lab/(?:LICEN[SC]E|COPYING)(?:\.[a-z]+)?")


def gather(folder: LabFolder, store: Store, revision: str, runs: Sequence[str], *, pictures: bool) -> Revision:
    """Return what is to be published of a revision: with the runs that its commit added or that led to its state, or
    with those of its `runs` that are named.

    Raises PicoError for an unknown revision or run, and for all files and artifacts that are missing or damaged.
    """
    commit = replace(folder.history().resolve(revision), refs=())  # names come and go, a commit gives the same bytes
    setup, state = folder.historic(commit.id)
    chosen = led = chosen_runs(folder, commit.id, state.digest(), ())
    if runs:
        chosen = chosen_runs(folder, commit.id, state.digest(), runs)
    files_of_runs, with_it = files_of(folder, store, chosen), tuple(run for run, _ in chosen)
    before = _state_before(folder, setup, commit.parents)
    changes = folder.entry(commit).changes
    lab = _lab_files(folder, commit.id)
    files = [
        *lab,
        *types(setup),
        *states(state, before, changes, commit.parents),
        plan_between(setup, before, state, commit),
        *(pictures_of(setup, state) if pictures else ()),
        *files_of_runs,
    ]
    return Revision(
        commit=commit,
        setup=setup,
        state=state.digest(),
        evidence=_evidence((run for run, _ in led), state.digest()),
        changes=changes,
        runs=with_it,
        files=tuple(sorted(files, key=lambda f: f.path)),
        license=next((f.path for f in lab if _LICENSE.fullmatch(f.path)), None),
    )


def _state_before(folder: LabFolder, setup: Setup, parents: tuple[str, ...]) -> LabState:
    """Return the state of the first parent as far as the bench of the revision has its parts, else home."""
    home = home_state(setup)
    try:
        before = folder.historic(parents[0])[1] if parents else home
    except PicoError:
        return home
    known = {
        name: part
        for name, part in before.components.items()
        if name in setup.lab.inventory and (part.slot is None or part.slot in setup.lab.slots)
    }
    return LabState(lab=setup.lab.name, components={**home.components, **known})


def _evidence(runs: Iterable[Run], digest: str) -> str:
    led = [run.evidence for run in runs if run.state_after == digest and run.outcome == "done"]
    return max(led, key=lambda e: STRENGTH[e], default="planned")


def _lab_files(folder: LabFolder, commit: str) -> list[File]:
    """Return the manifests of a revision and what stands beside them: what it is, whose, its calibration, its notes."""
    repository = folder.history()
    found = {path: (data, "manifest") for path, data in repository.files(commit, folder.root).items()}
    inside = repository.relative(folder.root)
    tops = dict.fromkeys(("", inside))  # a license at the top of the repository holds for a lab in a folder of it
    for top in tops:
        for path, data in _blobs(repository.handle[commit].tree, top):
            if _BESIDE.fullmatch(path) and (top == inside or _LICENSE.fullmatch(f"lab/{path}")):
                found[path] = (data, "file of the lab")
    return [file(f"lab/{path}", data, f"{path}, {said}") for path, (data, said) in sorted(found.items())]


def _blobs(tree: Any, folder: str, at: str = "") -> Iterator[tuple[str, bytes]]:
    """Yield the files of a folder, of `calibration` and `notes` in it, by path relative to it; links are left out."""
    from pygit2.enums import FileMode

    for entry in tree[folder] if folder else tree:
        path = f"{at}{entry.name}"
        if entry.filemode == FileMode.TREE and path in ("calibration", "notes"):
            yield from _blobs(entry, "", f"{path}/")
        elif entry.filemode in (FileMode.BLOB, FileMode.BLOB_EXECUTABLE):
            yield path, entry.data
