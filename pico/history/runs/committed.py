"""The runs that commits carry, found by what trees hold.

A commit's trailers are an index for people; what counts are the files. `git revert` of a commit takes its runs out of
the tip, so the history is looked through: every commit whose `runs` folder differs from that of its parents.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from pico.diagnostics import Diagnostic, warning
from pico.history.git.cache import Cache
from pico.history.git.commit import Commit
from pico.history.repository.repository import Repository
from pico.model.trace.run import FOLD, Run
from pico.runs.files import DOCUMENT
from pico.runs.folding import folded_ids
from pico.runs.reading import read_document

_PLACE = re.compile(r"\d{4}/\d{2}/")
_ADDED = re.compile(r"(?P<name>\d{4}/\d{2}/[^/]+):(?P<tree>[0-9a-f]{40,64})")
CACHE = "pico/runs.sqlite"
SLACK = 86400.0
"""Seconds by which the clocks of two machines may differ."""


@dataclass(frozen=True, slots=True)
class RunPlace:
    """Where a run lies: its id, its folder relative to the lab, the id of that folder's tree, and the oldest commit
    among those looked at that has it."""

    id: str
    path: str
    tree: str
    commit: str


def runs_added(
    repository: Repository, commit: str | Commit, folder: str | Path = "", diagnostics: list[Diagnostic] | None = None
) -> tuple[Run, ...]:
    """Return the runs that a commit (its id) added to the lab in `folder`, in the order in which they started.

    A merge adds what none of its parents has. A warning for each damaged document is appended to `diagnostics`.
    """
    name = commit if isinstance(commit, str) else commit.id
    trees = _Trees(repository, repository.relative(folder))
    added = trees.added(repository.handle[name])
    return read_carried(repository, added, diagnostics)


def places_added(repository: Repository, commit: str, folder: str | Path = "") -> tuple[RunPlace, ...]:
    """Return where the runs lie that a commit (its id) has and none of its parents."""
    return _Trees(repository, repository.relative(folder)).added(repository.handle[commit])


def places_at(repository: Repository, commit: str, folder: str | Path = "") -> dict[str, RunPlace]:
    """Return where the runs are whose files a commit (its id) holds, by id, whichever commit added them."""
    return _Trees(repository, repository.relative(folder)).places(repository.handle[commit])


def places_in_history(
    repository: Repository,
    folder: str | Path = "",
    tips: Iterable[str] | None = None,
    *,
    hidden: Iterable[str] = (),
    since: float | None = None,
) -> dict[str, RunPlace]:
    """Return where each run was added, by its id: looking through all that `tips` (commit ids; None: every branch and
    tag, and HEAD) reach and `hidden` do not, back to `since` [s since 1970]."""
    found: dict[str, RunPlace] = {}
    with closing(Cache(repository.common / CACHE)) as cache:
        trees = _Trees(repository, repository.relative(folder), cache)
        for handle in _walk(repository, tips, hidden, since):
            for place in trees.added(handle):
                found[place.id] = place  # the older one counts
    return found


def find_runs(repository: Repository, folder: str | Path, runs: Mapping[str, float]) -> dict[str, RunPlace]:
    """Return where those of some runs are that a branch or tag reaches, by id.

    `runs`: ids, with when each began [s since 1970]. What the tips have is quickly seen; only for the rest the history
    is looked through, back to the first of them.
    """
    trees = _Trees(repository, repository.relative(folder))
    there: dict[str, RunPlace] = {}
    for tip in tip_ids(repository) if runs else ():
        there |= trees.places(repository.handle[tip])
    found = _among(repository, there, runs)
    missing = {name: began for name, began in runs.items() if name not in found}
    if missing:
        found |= _among(repository, places_in_history(repository, folder, since=min(missing.values())), missing)
    return found


def _among(repository: Repository, places: Mapping[str, RunPlace], names: Iterable[str]) -> dict[str, RunPlace]:
    """Return where runs lie, in folders of their own or folded into others, as far as that is at some places."""
    wanted = set(names)
    found = {name: places[name] for name in wanted & places.keys()}
    folded = places_folded(repository, places.values()) if wanted - found.keys() else {}
    return found | {name: folded[name] for name in (wanted - found.keys()) & folded.keys()}


def places_folded(repository: Repository, places: Iterable[RunPlace]) -> dict[str, RunPlace]:
    """Return where the runs lie that were folded into those at some places, by the ids that they had."""
    found: dict[str, RunPlace] = {}
    with closing(Cache(repository.common / CACHE)) as cache:
        for place in places:
            if place.id.endswith(FOLD):
                key = f"folded {place.tree}"
                known = cache.get(key)
                if known is None:
                    known = " ".join(folded_ids(b"".join(files_at(repository, place, (DOCUMENT,)).values())))
                    cache.put(key, known)
                found |= dict.fromkeys(known.split(), place)
    return found


def read_carried(
    repository: Repository, places: Iterable[RunPlace], diagnostics: list[Diagnostic] | None = None
) -> tuple[Run, ...]:
    """Return the runs at some places, in the order in which they started; damaged documents as warnings."""
    found = []
    for place in places:
        document = read_place(repository, place)
        if isinstance(document, Run):
            found.append(document)
        elif diagnostics is not None:
            diagnostics.append(document)
    return tuple(sorted(found, key=lambda run: run.order))


def read_place(repository: Repository, place: RunPlace) -> Run | Diagnostic:
    """Return the document of the run at a place, or a warning that says what is wrong with it."""
    path, data = f"{place.path}/run.json", files_at(repository, place, ("run.json",))
    if path not in data:
        hint = "`git log -- FILE` shows who took it away"
        return warning("run-file", f"{path} is missing at {place.commit[:7]}", hint=hint)
    return read_document(path, data[path], place.id)


def files_at(repository: Repository, place: RunPlace, names: Iterable[str] | None = None) -> dict[str, bytes]:
    """Return the files of a run by path relative to the lab, all or those called `names`; links are left out."""
    from pygit2.enums import FileMode

    wanted = None if names is None else set(names)
    return {
        f"{place.path}/{entry.name}": entry.data
        for entry in repository.handle[place.tree]
        if entry.filemode in (FileMode.BLOB, FileMode.BLOB_EXECUTABLE) and (wanted is None or entry.name in wanted)
    }


def _walk(
    repository: Repository, tips: Iterable[str] | None, hidden: Iterable[str], since: float | None
) -> Iterator[Any]:
    """Yield the commits that `tips` reach, newest first."""
    from pygit2.enums import SortMode

    handle = repository.handle
    walker = handle.walk(None, SortMode.TIME if since is not None else SortMode.TOPOLOGICAL | SortMode.TIME)
    for tip in tip_ids(repository) if tips is None else tips:
        walker.push(tip)
    for commit in hidden:
        walker.hide(commit)
    for commit in walker:
        if since is not None and commit.commit_time < since - SLACK:
            return
        yield commit


def tip_ids(repository: Repository) -> tuple[str, ...]:
    """Return the commits that HEAD, branches (of remotes, too) and tags point at, each once."""
    from pico.history.git.revisions import names_at

    handle = repository.handle
    head = () if handle.head_is_unborn else (str(handle.head.target),)
    return tuple(dict.fromkeys((*head, *sorted(names_at(handle)))))


@dataclass(slots=True)
class _Trees:
    """The `runs` folders of commits; those that are the same are read once, and what a commit added only the first
    time, where a `cache` remembers it."""

    repository: Repository
    inside: str
    cache: Cache | None = None
    _known: dict[str, Mapping[str, str]] = field(default_factory=dict)

    def added(self, commit: Any) -> tuple[RunPlace, ...]:
        """Return the runs that a commit has and none of its parents."""
        own = self._runs(commit)
        before = [found for parent in self._parents(commit) if (found := self._runs(parent)) is not None]
        if own is None or any(b.id == own.id for b in before):
            return ()
        if not before:
            return tuple(self.places(commit).values())
        fresh = self._remembered(own, before)
        return tuple(RunPlace(n[8:], f"runs/{n}", tree, str(commit.id)) for n, tree in fresh.items())

    def _remembered(self, own: Any, before: list[Any]) -> dict[str, str]:
        """Return the runs, as `2026/11/<id>` with their trees, that one `runs` folder has and none of those `before`.

        A month of many runs is a large tree, and is not read again where it is known what it adds.
        """
        key = " ".join(["added", str(own.id), *sorted(str(b.id) for b in before)])
        known = self.cache.get(key) if self.cache else None
        words = [_ADDED.fullmatch(word) for word in (known or "").split()]
        if known is not None and all(word and word["tree"] in self.repository.handle for word in words):
            return {word["name"]: word["tree"] for word in words if word}
        fresh = {name: str(own[name].id) for name in sorted(set.intersection(*(_fresh(b, own) for b in before)))}
        if self.cache:
            self.cache.put(key, " ".join(f"{name}:{tree}" for name, tree in fresh.items()))
        return fresh

    def places(self, commit: Any) -> dict[str, RunPlace]:
        """Return the runs that a commit has, by id."""
        own = self._runs(commit)
        listed = self._listed(own) if own is not None else {}
        return {name: RunPlace(name, path, tree, str(commit.id)) for name, (path, tree) in listed.items()}

    def _parents(self, commit: Any) -> list[Any]:
        """Return the parents that are here: a shallow clone does not have all."""
        handle = self.repository.handle
        return [handle[p] for p in commit.parent_ids if p in handle]

    def _runs(self, commit: Any) -> Any:
        import pygit2

        try:
            found = commit.tree[f"{self.inside}/runs" if self.inside else "runs"]
        except KeyError:
            return None
        return found if isinstance(found, pygit2.Tree) else None

    def _listed(self, tree: Any) -> dict[str, tuple[str, str]]:
        """Return path and tree of each run below a `runs` folder, by its id."""
        found: dict[str, tuple[str, str]] = {}
        for year in _folders(tree):
            for month in _folders(year):
                at = f"runs/{year.name}/{month.name}"
                if not _PLACE.fullmatch(f"{year.name}/{month.name}/"):
                    continue
                found |= {name: (f"{at}/{name}", own) for name, own in self._month(month).items()}
        return found

    def _month(self, tree: Any) -> Mapping[str, str]:
        key = str(tree.id)
        if key not in self._known:
            self._known[key] = {run.name: str(run.id) for run in _folders(tree)}
        return self._known[key]


def _fresh(before: Any, own: Any) -> set[str]:
    """Return the runs, as `2026/11/<id>`, that one `runs` folder has and another has not."""
    paths = (PurePosixPath(delta.new_file.path).parts for delta in before.diff_to_tree(own).deltas)
    return {name for p in paths if len(p) == 4 and _PLACE.match(name := "/".join(p[:3])) and name not in before}


def _folders(tree: Any) -> list[Any]:
    from pygit2.enums import FileMode

    return [entry for entry in tree if entry.filemode == FileMode.TREE]
