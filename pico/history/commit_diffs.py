"""What commits changed on the table, of many commits in a row: only files that differ are read, each of them once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import PurePosixPath
from typing import Any, Literal

from pico.diagnostics import PicoError
from pico.history.commit import Commit
from pico.history.folder import STATE_ONLY, Entry, LabFolder, between
from pico.history.trees import is_manifest, left_out
from pico.manifest.load import load_files
from pico.model.diff import Change, diff_states
from pico.model.lab import Setup
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
        self._kinds: dict[str, Kind] = {}
        self._benches: dict[BenchFiles, Setup] = {}
        self._states: dict[tuple[str, BenchFiles], Mapping[str, ComponentState]] = {}

    def entry(self, commit: Commit, *, names: Iterable[str] = ()) -> Entry:
        """Return a commit with its physical diff against its first parent, as `LabFolder.entry` does.

        With `names`, only what these components do is looked for; files that don't name them are not read.
        """
        if not commit.parents:
            return self.folder.entry(commit)
        try:
            return Entry(commit=commit, changes=self.changes(commit.parents[0], commit.id, names=names))
        except PicoError:
            return self.folder.entry(commit)

    def changes(self, a: str, b: str, *, names: Iterable[str] = ()) -> tuple[Change, ...]:
        """Return what differs from commit `a` to `b` (ids); raises PicoError where either can't be read."""
        before, after = self.files(a), self.files(b)
        paths = sorted(p for p in before.keys() | after.keys() if before.get(p) != after.get(p))
        if not paths:
            return ()
        if self._bench_files(before) != self._bench_files(after):
            return between(self.folder.historic(a), self.folder.historic(b))
        wanted = tuple(names)
        if wanted and not any(self._mentions(files.get(p), wanted) for p in paths for files in (before, after)):
            return ()
        key = self._bench_files(before)
        states = [self._state(key, [files[p] for p in paths if p in files]) for files in (before, after)]
        return diff_states(self._bench(key), states[0], states[1])

    def files(self, commit: str) -> Files:
        """Return the manifests of a commit (its id)."""
        import pygit2

        tree = self._git[commit].tree
        try:
            tree = tree[self._inside] if self._inside else tree
        except KeyError:
            return {}
        if not isinstance(tree, pygit2.Tree):
            return {}
        key = str(tree.id)
        if key not in self._files:
            if len(self._files) > 50:
                del self._files[next(iter(self._files))]
            self._files[key] = _below(tree, PurePosixPath())
        return self._files[key]

    def components_of(self, commit: str, path: str) -> frozenset[str]:
        """Return the components that the manifests at `path` (a file or a folder, relative to the lab) hold."""
        from pico.history.surroundings import components_in

        names = [n for p, n in self.files(commit).items() if p == path or p.startswith(f"{path}/") or path in ("", ".")]
        return frozenset().union(*(components_in(self.repository.blob(name)) for name in names))

    def _mentions(self, name: str | None, components: tuple[str, ...]) -> bool:
        data = self.repository.blob(name) if name else b""
        return any(component.encode() in data for component in components)

    def _bench_files(self, files: Files) -> BenchFiles:
        return tuple((path, name) for path, name in files.items() if self._kind(name) == "bench")

    def _kind(self, name: str) -> Kind:
        if name not in self._kinds:
            data = self.repository.blob(name)
            self._kinds[name] = "foreign" if b"pico/" not in data else "state" if STATE_ONLY.search(data) else "bench"
        return self._kinds[name]

    def _bench(self, key: BenchFiles) -> Setup:
        if key not in self._benches:
            read = load_files({path: self.repository.blob(name) for path, name in key})
            self._benches[key] = read.setup or self.folder.setup
        return self._benches[key]

    def _state(self, key: BenchFiles, names: Iterable[str]) -> LabState:
        components: dict[str, ComponentState] = {}
        for name in names:
            components |= self._components(key, name) if self._kind(name) == "state" else {}
        return LabState(lab=self._bench(key).lab.name, components=components)

    def _components(self, key: BenchFiles, name: str) -> Mapping[str, ComponentState]:
        if (name, key) not in self._states:
            if len(self._states) > _MOST_STATES:
                del self._states[next(iter(self._states))]
            files = {"state": self.repository.blob(name)}
            self._states[name, key] = load_files(files, setup=self._bench(key), whole=False).require()[1].components
        return self._states[name, key]


def _below(tree: Any, at: PurePosixPath) -> dict[str, str]:
    """Return the manifests below a tree; links and submodules are none."""
    from pygit2.enums import FileMode

    found: dict[str, str] = {}
    for entry in tree:
        path = at / entry.name
        if entry.filemode == FileMode.TREE:
            found |= {} if left_out(str(path / "*")) else _below(entry, path)
        elif entry.filemode in (FileMode.BLOB, FileMode.BLOB_EXECUTABLE) and is_manifest(str(path)):
            found[str(path)] = str(entry.id)
    return found
