"""Blame of the commits of a repository: from the cache, else from the nearest answer there on, else from the start."""

from __future__ import annotations

import contextlib
import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import PurePosixPath
from typing import Any

from pico.diagnostics import PicoError, error
from pico.history.blame.answer import Answer, Unread, answer, dumps, loads
from pico.history.blame.flat import Flat, flatten
from pico.history.blame.flat import loads as flat_from
from pico.history.blame.follow import Blame, Delta, WalkStep, walk
from pico.history.blame.how import RunBrief, brief_of
from pico.history.git.cache import VERSION, Cache
from pico.history.git.shallow import boundary
from pico.history.git.unread import modules
from pico.history.repository.repository import Repository
from pico.manifest.file_names import MAX_BYTES, is_manifest
from pico.model.trace.run import Run
from pico.resources import catalog_dir

CACHE = "pico/blame.sqlite"
_RUN = re.compile(r"runs/\d{4}/\d{2}/[^/]+/run\.json")
_MOST_UNREAD = 20
_MODULE = 0o160000
RunFile = tuple[str, str]
"""A `run.json` that a commit added: its path below the lab, and the id of its content."""


class Walker:
    """Reads the history of the lab in `folder` (relative to the repository's top; empty: the top)."""

    def __init__(self, repository: Repository, folder: str) -> None:
        self.repository, self.folder = repository, folder
        self._git: Any = repository.handle
        self.cache = Cache(repository.common / CACHE)
        self.shallow = boundary(repository.common)
        here = sorted(str(path) for path in repository.common.glob("modules/*"))
        self._lab = _digest(VERSION, folder, _catalog_stamp(), sorted(self.shallow), here)
        self._unread: list[Unread] = []
        self._runs: dict[str, tuple[RunFile, ...]] = {}
        self._known: dict[str, tuple[RunBrief, ...]] = {}
        self._folders: dict[str, str] = {}  # where the lab was at a commit, if it was moved since
        self._modules = modules(repository, folder)
        self._foreign: dict[str, Any] = {}  # files in submodules, which lie in repositories of their own

    def answer(self, commit: str) -> Answer:
        """Return the blame of a commit, and keep it; raises PicoError where Git's objects are damaged."""
        found = self._kept(commit)
        if found is None:
            found = answer(self.blame(commit), packaged_units, self._unread)
            found = replace(
                found, runs=self._briefs({n.commit for row in found.rows.values() for n in row.node.chain()})
            )
            self.cache.flush()
            self.cache.put_result(self._lab, commit, dumps(found))
        return found

    def blame(self, commit: str) -> Blame:
        """Return the blame of a commit as what a walk can go on from."""
        start = self._nearest(commit)
        known = self._rebuilt(start) if start else None
        if known and start == commit:
            return known
        try:
            steps = self._steps(commit, start if known else None)
            return walk(steps, self._delta, packaged_units, {start: known} if start and known else None)
        except (KeyError, ValueError) as exc:
            hint = "`git fsck` says which; `git fetch` may bring it back"
            raise PicoError(
                error("git-unreadable", "an object of the history is missing or damaged", detail=str(exc), hint=hint)
            ) from exc

    def files(self, commit: str) -> dict[str, str]:
        """Return the manifests of a commit: their ids by path below the lab."""
        return {path: name for path, name in self._below(self._tree(commit)) if is_manifest(path)}

    def content(self, commit: str, path: str) -> bytes:
        """Return a file of the lab at a commit; empty where there is none."""
        tree = self._tree(commit)
        entry = tree[path] if tree is not None and path in tree else None
        return self._content(str(entry.id)) if entry is not None and _regular(entry.filemode) else b""

    def flat(self, name: str) -> Flat:
        """Return what a manifest says, by the id of its content."""
        text = self.cache.get(f"flat {name}")
        if text is not None:
            with contextlib.suppress(ValueError, TypeError, AttributeError):
                return flat_from(text)
        flat = flatten(self._content(name))
        self.cache.put(f"flat {name}", flat.dumps())
        return flat

    def _briefs(self, commits: Iterable[str]) -> dict[str, tuple[RunBrief, ...]]:
        """Return what the runs changed that some commits brought along; those that can't be read are left out."""
        found = {name: self._known[name] for name in commits if name in self._known}
        for name in commits:
            if name in self._runs:
                found[name] = tuple(brief for file in self._runs[name] for brief in self._read(*file))
        return found

    def _read(self, path: str, name: str) -> tuple[RunBrief, ...]:
        """Return a run, or those that are folded into it; nothing of a damaged one."""
        from pico.runs.reading import members, read_document

        document = read_document(path, self._content(name), PurePosixPath(path).parent.name)
        return tuple(brief_of(run) for run in members(document) or [document]) if isinstance(document, Run) else ()

    def _content(self, name: str) -> bytes:
        blob = (
            self._foreign.get(name) or self._git[name]
        )  # of one that is too large, as much as makes the reader say so
        return bytes(blob.data) if blob.size <= MAX_BYTES else b"#" * (MAX_BYTES + 1)

    def _kept(self, commit: str) -> Answer | None:
        text = self.cache.result(self._lab, commit)
        with contextlib.suppress(ValueError, TypeError, IndexError, AttributeError):
            return loads(text) if text is not None else None
        return None

    def _nearest(self, commit: str) -> str | None:
        """Return the commit with an answer that the fewest commits separate from this one, among its ancestors."""
        best: tuple[int, str] | None = None
        for name in self.cache.results(self._lab):
            if name not in self._git:
                continue
            ahead, behind = self._git.ahead_behind(commit, name)
            if not behind and (best is None or ahead < best[0]):
                best = (ahead, name)
        return best[1] if best else None

    def _rebuilt(self, commit: str) -> Blame | None:
        found = self._kept(commit)
        if not self.has_lab(commit):
            return None  # it may have been elsewhere
        files = {path: self.flat(name) for path, name in self.files(commit).items()}
        if found is None or any(flat.wrong for flat in files.values()):
            return None  # what a file said before it could not be read is not in the answer
        self._unread, self._known = list(found.unread), dict(found.runs)
        return Blame.of(files, {at: row.node for at, row in found.rows.items()})

    def _steps(self, commit: str, start: str | None) -> list[WalkStep]:
        """Return the commits from `start` on, parents first; all of them where others than it lead there, too."""
        from pygit2.enums import SortMode

        walker = self._git.walk(commit, SortMode.TOPOLOGICAL | SortMode.REVERSE)
        if start:
            walker.hide(start)
        steps = [WalkStep(str(c.id), tuple(str(p) for p in c.parent_ids)) for c in walker]
        if start and not {p for s in steps for p in s.parents} <= {start, *(s.commit for s in steps)}:
            return self._steps(commit, None)
        self._follow(steps)
        return steps

    def _follow(self, steps: Sequence[WalkStep]) -> None:
        """Find out where the lab was before its folder was moved."""
        for step in reversed(steps) if self.folder else ():
            here = self._folders.setdefault(step.commit, self.folder)
            for parent in step.parents:
                if parent not in self._folders:
                    self._folders[parent] = (
                        here if self._tree(parent, here) is not None else self._before(step.commit, parent, here)
                    )

    def _before(self, commit: str, parent: str, here: str) -> str:
        """Return the folder that held at `parent` the Lab that `here` holds at `commit`; `here` where none did."""
        found = [name for path, name in self._below(self._tree(commit, here)) if "/" not in path and is_manifest(path)]
        labs = {name for name in found if self.flat(name).inventory}
        before = next((path for path, name in self._below(self._git[parent].tree) if name in labs), None)
        return here if before is None else before.rpartition("/")[0]

    def _delta(self, commit: str, base: str | None) -> Delta:
        changed = dict(self._changed(self._tree(base) if base else None, self._tree(commit)))
        runs = tuple((path, name) for path, name in changed.items() if name and _RUN.fullmatch(path))
        if runs:
            runs = self._not_merged(commit, runs)
            self._runs[commit] = runs
        delta = {path: self.flat(name) if name else None for path, name in changed.items() if is_manifest(path)}
        wrong = [Unread(commit, path, flat.wrong) for path, flat in delta.items() if flat and flat.wrong]
        self._unread = [*self._unread, *wrong][-_MOST_UNREAD:] if wrong else self._unread
        return delta

    def _not_merged(self, commit: str, runs: tuple[RunFile, ...]) -> tuple[RunFile, ...]:
        """Return the runs that no parent but the first has either."""
        others = [self._tree(str(p)) for p in self._git[commit].parent_ids[1:]]
        return tuple(run for run in runs if not any(tree is not None and run[0] in tree for tree in others))

    def _changed(self, before: Any, after: Any) -> Iterator[tuple[str, str | None]]:
        """Yield the files that differ between two trees, by path, with their new id; None for what is no file any
        more."""
        if before is None or after is None:
            yield from ((path, None) for path, _ in self._below(before))
            yield from self._below(after)
            return
        if before.id == after.id:
            return
        for delta in before.diff_to_tree(after).deltas:
            file = delta.new_file
            yield file.path, str(file.id) if _regular(file.mode) else None
            for tree, told in ((before, False), (after, True)):
                if _MODULE in (delta.old_file.mode, file.mode) and file.path in tree:
                    found = self._below([tree[file.path]], file.path.rpartition("/")[0])
                    yield from ((path, name if told else None) for path, name in found)

    def _below(self, tree: Any, at: str = "", *, foreign: bool = False) -> Iterator[tuple[str, str]]:
        for entry in tree if tree is not None else ():
            path = f"{at}/{entry.name}".lstrip("/")
            if entry.type_str == "tree":
                yield from self._below(entry, path, foreign=foreign)
            elif _regular(entry.filemode):
                self._foreign |= {str(entry.id): entry} if foreign else {}
                yield path, str(entry.id)
            else:
                yield from self._below(self._modules(path, entry), path, foreign=True)

    def has_lab(self, commit: str) -> bool:
        """Return whether the lab's folder is there at a commit."""
        return self._tree(commit) is not None

    def _tree(self, commit: str, folder: str | None = None) -> Any:
        """Return the lab's folder in a commit, None where it has none."""
        import pygit2

        tree = self._git[commit].tree
        inside = self._folders.get(commit, self.folder) if folder is None else folder
        try:
            found = tree[inside] if inside else tree
        except KeyError:
            return None
        return found if isinstance(found, pygit2.Tree) else None


@cache
def packaged_units(kind: str) -> Mapping[str, str]:
    """Return the units of the tunables of a packaged component type; none where there is no such type."""
    path = catalog_dir() / f"{kind}.yaml"
    if not kind.isidentifier() or not path.is_file():
        return {}
    return flatten(path.read_bytes()).units.get(kind, {})


def _regular(mode: int) -> bool:
    """Whether this is a file: no link, no submodule, not gone."""
    return mode & 0o170000 == 0o100000


def _catalog_stamp() -> list[tuple[str, int, int]]:
    found = ((path.name, path.stat()) for path in sorted(catalog_dir().glob("*.yaml")))
    return [(name, stat.st_size, stat.st_mtime_ns) for name, stat in found]


def _digest(*parts: object) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]
