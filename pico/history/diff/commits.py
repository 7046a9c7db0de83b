"""What commits changed on the table, of many commits in a row: only files that differ are read, each of them once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, Literal

from pico.diagnostics import Diagnostic, PicoError
from pico.history.git.commit import Commit
from pico.history.git.trees import Odd, manifests, subtree
from pico.history.git.unread import unread_at
from pico.history.lab.folder import CommitEntry, LabFolder, between
from pico.manifest.bench_view import BenchView, view_of
from pico.manifest.files import decode, states_alone
from pico.manifest.load import load_files
from pico.manifest.state import read_states
from pico.manifest.text.kinds import kind_of
from pico.manifest.text.tree import parse
from pico.model.diff import Change, diff_states
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState

Files = Mapping[str, str]
"""The manifests of a commit: the ids of their contents, by path relative to the lab."""
BenchFiles = tuple[tuple[str, str], ...]
Kind = Literal["state", "bench", "foreign"]
_MOST_STATES = 2000


class CommitDiffs:
    """Reads commits of the repository around a lab's folder."""

    def __init__(self, folder: LabFolder) -> None:
        self.folder, self.repository = folder, folder.history()
        self._git: Any = self.repository.handle
        self._inside = self.repository.relative(folder.root)
        self._files: dict[str, Files] = {}
        self._odd: dict[str, list[Odd]] = {}
        self._unread: dict[str, list[Diagnostic]] = {}
        self._kinds: dict[str, Kind] = {}
        self._benches: dict[BenchFiles, tuple[Setup, BenchView]] = {}
        self._states: dict[tuple[str, BenchFiles], Mapping[str, ComponentState]] = {}

    def entry(self, commit: Commit, *, names: Iterable[str] = ()) -> CommitEntry:
        """Return a commit with its physical diff against its first parent, as `LabFolder.entry` does.

        With `names`, only what these components do is looked for; files that don't name them are not read.
        """
        if not commit.parents or commit.parents[0] not in self._git:
            return self.folder.entry(commit)
        try:
            return CommitEntry(commit=commit, changes=self.changes(commit.parents[0], commit.id, names=names))
        except PicoError:
            return self.folder.entry(commit)

    def changes(self, a: str, b: str, *, names: Iterable[str] = ()) -> tuple[Change, ...]:
        """Return what differs from commit `a` to `b` (ids); raises PicoError where either can't be read."""
        before, after = self.files(a), self.files(b)
        wrong = [d for commit in (a, b) for d in self._unread.get(commit, ()) if d.severity == "error"]
        if wrong:
            raise PicoError(wrong)
        paths = sorted(p for p in before.keys() | after.keys() if before.get(p) != after.get(p))
        if not paths:
            return ()
        if self._bench_files(before) != self._bench_files(after):
            return between(self.folder.historic(a), self.folder.historic(b))
        wanted = tuple(names)
        sides = [[files[p] for p in paths if p in files] for files in (before, after)]
        if wanted:
            sides = [[name for name in side if self._mentions(name, wanted)] for side in sides]
            if not any(sides):
                return ()
        key = self._bench_files(before)
        states = [self._state(key, side) for side in sides]
        return diff_states(_small(self._bench(key)[0], states), states[0], states[1])

    def files(self, commit: str) -> Files:
        """Return the manifests of a commit (its id); none of one that a shallow clone does not have."""
        tree = subtree(self._git[commit].tree, self._inside) if commit in self._git else None
        if tree is None:
            return {}
        key = str(tree.id)
        if key not in self._files:
            if len(self._files) > 50:
                del self._files[next(iter(self._files))]
            odd: list[Odd] = []
            self._files[key] = {path: str(entry.id) for path, entry in manifests(tree, odd)}
            self._odd |= {key: odd} if odd else {}
        if key in self._odd:
            self._unread[commit] = unread_at(
                self.repository, self._git[commit].tree, self._inside, self._odd[key], commit[:7]
            )
        return self._files[key]

    def components_of(self, commit: str, path: str) -> frozenset[str]:
        """Return the components that the manifests at `path` (a file or a folder, relative to the lab) hold."""
        from pico.history.diff.surroundings import components_in

        names = [n for p, n in self.files(commit).items() if p == path or p.startswith(f"{path}/") or path in ("", ".")]
        return frozenset().union(*(components_in(self.repository.blob(name)) for name in names))

    def _mentions(self, name: str, components: tuple[str, ...]) -> bool:
        data = self.repository.blob(name)
        return any(component.encode() in data for component in components)

    def _bench_files(self, files: Files) -> BenchFiles:
        return tuple((path, name) for path, name in files.items() if self._kind(name) == "bench")

    def _kind(self, name: str) -> Kind:
        if name not in self._kinds:
            data = self.repository.blob(name)
            self._kinds[name] = "foreign" if b"pico/" not in data else "state" if states_alone(data) else "bench"
        return self._kinds[name]

    def _bench(self, key: BenchFiles) -> tuple[Setup, BenchView]:
        if key not in self._benches:
            read = load_files({path: self.repository.blob(name) for path, name in key})
            bench = read.setup or self.folder.setup
            self._benches[key] = bench, view_of(bench)
        return self._benches[key]

    def _state(self, key: BenchFiles, names: Iterable[str]) -> LabState:
        components: dict[str, ComponentState] = {}
        for name in names:
            components |= self._components(key, name) if self._kind(name) == "state" else {}
        return LabState(lab=self._bench(key)[0].lab.name, components=components)

    def _components(self, key: BenchFiles, name: str) -> Mapping[str, ComponentState]:
        if (name, key) not in self._states:
            if len(self._states) > _MOST_STATES:
                del self._states[next(iter(self._states))]
            self._states[name, key] = _read(self.repository.blob(name), self._bench(key)[1])
        return self._states[name, key]


def _read(data: bytes, view: BenchView) -> Mapping[str, ComponentState]:
    """Return the components of one file of a state; raises PicoError where it is wrong."""
    source, found = decode("state", data)
    documents, wrong = parse(source) if source else ([], [])
    state, misfits = read_states([d for d in documents if kind_of(d)[0] == "LabState"], view, whole=False)
    if state is None or any(d.severity == "error" for d in (*found, *wrong)):
        raise PicoError([*found, *wrong, *misfits])
    return state.components


def _small(bench: Setup, states: Iterable[LabState]) -> Setup:
    """Return a bench with only the parts that some states name: the others are at home in all of them."""
    parts = {n: bench.lab.inventory[n] for state in states for n in state.components if n in bench.lab.inventory}
    return replace(bench, lab=replace(bench.lab, inventory=parts))
