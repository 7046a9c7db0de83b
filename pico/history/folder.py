"""A lab's folder: its manifests as they are in the working tree, and its states at any revision."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.commit import Commit, Head
from pico.history.run_files import run_trailers, write_once
from pico.history.trailers import EVIDENCE, LAB, META, RUN, STATE, require_meta, with_trailers
from pico.manifest.files import read_folder
from pico.manifest.load import Manifests, find_lab, load_files, load_folder
from pico.model.diff import Change, diff_states
from pico.model.lab import Setup
from pico.model.record import record
from pico.model.report import Captured, Committed
from pico.model.state import LabState, home_state

if TYPE_CHECKING:
    from pico.history.repository import Repository

STATE_ONLY = re.compile(rb"\A(?!.*^kind:\s*(?:Lab|ComponentType)\s*$).*^kind:\s*LabState", re.MULTILINE | re.DOTALL)
"""Matches the content of a file that holds states alone, nothing of the bench."""


@record
class Entry:
    """One commit with what it changed on the table against its first parent, or why that can't be told."""

    commit: Commit
    changes: tuple[Change, ...] = ()
    unreadable: str = ""


class LabFolder:
    """The lab that `path` lies in. Raises PicoError where there is none, or where its manifests are wrong."""

    def __init__(self, path: Path) -> None:
        self.root = find_lab(path)
        self._benches: dict[tuple[tuple[str, bytes], ...], Setup | None] = {}
        self.reload()

    def reload(self) -> None:
        """Read the manifests again, after somebody wrote them; raises PicoError where they are wrong.

        `setup`: the bench as it is now, with its types; `state`: the desired state, what the working tree says.
        """
        self.manifests = load_folder(self.root)
        self.setup, self.state = self.manifests.require()

    @cached_property
    def repository(self) -> Repository | None:
        """The Git repository around the lab, or None."""
        from pico.history.repository import Repository

        return Repository.discover(self.root)

    def history(self) -> Repository:
        """Return the repository; raises PicoError that says how to get one."""
        if self.repository is None:
            hint = 'make one here: `git init && git add . && git commit -m "the lab as it is"`'
            raise PicoError(
                error("git-none", f"{self.root} is in no Git repository, so there is no history", hint=hint)
            )
        return self.repository

    def head(self) -> Head | None:
        """Return what is checked out; None outside a repository."""
        return self.repository.head() if self.repository else None

    def state_at(self, revision: str) -> LabState:
        """Return the state that a revision holds, read against the bench as it is now.

        Raises PicoError for an unknown revision and for manifests that don't fit this bench.
        """
        return self.manifests_at(revision).require()[1]

    def manifests_at(self, revision: str) -> Manifests:
        """Return the manifests of a revision, its states read against the bench as it is now."""
        files = self.history().files(revision, self.root)
        manifests = load_files(_named(revision, files), setup=self.setup)
        return replace(manifests, diagnostics=tuple(_at_revision(d, revision) for d in manifests.diagnostics))

    def historic(self, revision: str) -> tuple[Setup, LabState]:
        """Return the bench and the state as a revision holds them, both as they were then; raises PicoError.

        A revision without a Lab of its own is read against the bench as it is now.
        """
        files = self.history().files(revision, self.root)
        bench = tuple(sorted((p, data) for p, data in files.items() if not STATE_ONLY.search(data)))
        if bench not in self._benches:
            self._benches[bench] = load_files(_named(revision, files)).setup
        return load_files(_named(revision, files), setup=self._benches[bench] or self.setup).require()

    def committed(self) -> LabState | None:
        """Return the state at HEAD, as far as the bench as it is now has its parts and slots.

        None outside a repository, before the first commit of the lab, or where it can't be read.
        """
        head = self.head()
        if head is None or head.commit is None:
            return None
        try:
            _, state = self.historic(head.commit)
        except PicoError:
            return None
        lab = self.setup.lab
        fitting = {
            name: part
            for name, part in state.components.items()
            if name in lab.inventory and (part.slot is None or part.slot in lab.slots)
        }
        return replace(state, components=fitting)

    def diff(self, a: str | None = None, b: str | None = None) -> tuple[Change, ...]:
        """Return what differs from revision `a` (HEAD) to `b` (the working tree), exactly; raises PicoError."""
        return between(self.historic(a or "HEAD"), self.historic(b) if b else (self.setup, self.state))

    def entry(self, commit: Commit) -> Entry:
        """Return a commit with its physical diff. What a first commit is compared with is every part at home."""
        try:
            after = self.historic(commit.id)
        except PicoError as exc:
            return Entry(commit=commit, unreadable=str(exc.diagnostics[0].summary))
        home = (after[0], home_state(after[0]))
        try:
            before = self.historic(commit.parents[0]) if commit.parents else home
        except PicoError:
            before = home
        return Entry(commit=commit, changes=between(before, after))

    def log(self, revision: str | None = None, *, every: bool = False, limit: int | None = None) -> Iterator[Entry]:
        """Yield the commits that changed the lab, newest first: of a revision (HEAD), or of `every` branch and tag."""
        repository = self.history()
        tips = repository.tips() if every else (revision or "HEAD",)
        for commit in repository.log(tips, folder=self.root, limit=limit):
            yield self.entry(commit)

    def refuse_edits(self) -> None:
        """Raise PicoError where the manifests hold edits that a checkout would lose."""
        edited = self.history().changed(self.root)
        if edited:
            raise PicoError(_edited(edited))

    def capture(self, live: LabState) -> Captured:
        """Write what `live` says otherwise than the manifests, beyond tolerance, into them; raises PicoError."""
        from pico.manifest.edit import capture

        before = self.state
        files, _ = read_folder(self.root)
        written = capture(files, self.setup, before, live)
        for path, data in written.items():
            _replace(Path(path), data)
        self.reload()
        return Captured(changes=diff_states(self.setup, before, self.state), files=tuple(sorted(written)))

    def commit(
        self,
        message: str,
        captured: tuple[Change, ...],
        evidence: str,
        *,
        runs: Mapping[str, bytes] = MappingProxyType({}),
        meta: Mapping[str, str] = MappingProxyType({}),
    ) -> Committed:
        """Commit the manifests as they are, with the files of runs, and return the commit; raises PicoError.

        `runs`: files by path relative to the lab, `runs/YYYY/MM/<run id>/...`; written here, never over another file.
        `meta`: what `--meta key=value` gave. Trailers say the digest of the state and of the lab, the `evidence`, the
        runs with their plans, and `meta`; they go into the block of trailers that `message` has.
        """
        require_meta(meta)
        repository = self.history()
        written = [write_once(self.root / path, data) for path, data in sorted(runs.items())]
        paths: list[str | Path] = [*repository.changed(self.root), *written]
        if not paths:
            hint = "`pico status` shows the bench, `pico log` what there is"
            raise PicoError(error("nothing-to-commit", "nothing to commit: the manifests are as in HEAD", hint=hint))
        digest, lab = self.state.digest(), self.setup.lab
        added = [(STATE, digest), (EVIDENCE, evidence), (LAB, f"{lab.name} {self.setup.digest()}")]
        added += [(META, f"{key}={value}") for key, value in sorted(meta.items())]
        made = repository.commit(paths, with_trailers(message, [*added, *run_trailers(runs)]))
        return Committed(
            commit=made.id,
            message=message.strip(),
            branch=repository.head().branch,
            state=digest,
            changes=self.entry(made).changes,
            captured=captured,
            realized=evidence != "planned",
            runs=tuple(value for key, value in run_trailers(runs) if key == RUN),
            meta=meta,
        )


def _named(revision: str, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the files by the names that diagnostics show: `e1:state/table.yaml`."""
    return {f"{revision}:{path}": data for path, data in files.items()}


def _at_revision(d: Diagnostic, revision: str) -> Diagnostic:
    """Return a diagnostic of a state from history: what the bench lacks now, it may have had then."""
    if d.code != "unknown-component":
        return d
    hint = f"{revision} was made when the bench had it: take it into `inventory` again, or go to another revision"
    return replace(d, hint=hint)


def between(a: tuple[Setup, LabState], b: tuple[Setup, LabState]) -> tuple[Change, ...]:
    """Return what differs between two states, each with its own bench; where the benches differ, the later counts."""
    (bench_a, state_a), (bench_b, state_b) = a, b
    lab = replace(
        bench_b.lab,
        inventory={**bench_a.lab.inventory, **bench_b.lab.inventory},
        slots={**bench_a.lab.slots, **bench_b.lab.slots},
    )
    return diff_states(Setup(lab=lab, catalog={**bench_a.catalog, **bench_b.catalog}), state_a, state_b)


def _replace(path: Path, data: bytes) -> None:
    """Write a file so that a reader sees the old one or the new one; its permissions stay."""
    fresh = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    fresh.write_bytes(data)
    shutil.copymode(path, fresh)
    fresh.replace(path)


def _edited(paths: tuple[str, ...]) -> Diagnostic:
    return error(
        "edited",
        f"{', '.join(paths[:3])}{' and others' if len(paths) > 3 else ''} differ from the last commit",
        hint='`pico commit -m "why"` keeps the edits, `git stash` shelves them, `git restore .` drops them',
    )
