"""The commits that `pico log` shows: git picks and orders them, PICO says what each did to the table."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import chain, islice

from pico.diagnostics import PicoError
from pico.history.diff.commits import CommitDiffs
from pico.history.git import command as git
from pico.history.git.commit import Commit
from pico.history.lab.folder import CommitEntry, LabFolder
from pico.history.lab.notes import Note, note_path, notes, read_note
from pico.history.lab.scope import Scope, unknown_parts
from pico.history.repository.ranges import for_rev_list
from pico.history.runs.committed import runs_added
from pico.history.runs.proof import Standings
from pico.model.address import former_names, renaming_of
from pico.model.diff import Change

_BATCHES = (1, 8, 64)
"""How many commits are read at once: first one, so that it can be shown."""


@dataclass(frozen=True, slots=True)
class LogRequest:
    """Which commits: revisions and ranges (HEAD for none), or `every` branch and tag; `options` are those of `git
    rev-list` that pick commits (`--since=...`); `topological`: lines of history one after the other, for a graph."""

    revisions: tuple[str, ...] = ()
    every: bool = False
    options: tuple[str, ...] = ()
    limit: int | None = None
    scope: Scope = field(default_factory=Scope)
    topological: bool = False


class Log:
    """The commits that were asked for. Iterate over it for entries, newest first, each read when it is reached."""

    def __init__(self, folder: LabFolder, asked: LogRequest) -> None:
        self.folder, self.asked = folder, asked
        self.repository = folder.history()
        self._real: dict[str, Commit] = {}  # with the parents that they have, shown or not
        self._entries: dict[str, CommitEntry] = {}
        self._standings = Standings(folder)

    def __iter__(self) -> Iterator[CommitEntry]:
        for commit in self.commits():
            yield self.entry(commit)

    def commits(self) -> Iterator[Commit]:
        """Yield the commits, each with the nearest of those before it that are shown as parents.

        Without a graph to be drawn, commits in between may stand for them. Raises PicoError.
        """
        shown = self._picked()
        if self.asked.scope.parts:
            shown = self._about(shown)
        yield from islice(shown, self.asked.limit)

    def entry(self, commit: Commit) -> CommitEntry:
        """Return a commit of `commits` with what it did."""
        found = self._entries.pop(commit.id, None) or self._read(commit)
        runs = runs_added(self.repository, commit, self.folder.root)
        first = not any(self._diffs.files(parent) for parent in self._real[commit.id].parents[:1])
        return replace(found, commit=commit, runs=runs, first=first, standing=self._standings.at_a_glance(commit, runs))

    def notes(self) -> dict[str, tuple[Note, ...]]:
        """Return what people noted on the components that were asked for, as the working tree has it."""
        found = {}
        names, root = renaming_of(self.folder.setup.lab), self.folder.root
        for part in (name for name in self.asked.scope.parts if name not in names):
            called = (*former_names(self.folder.setup.lab, part), part)
            if said := notes({note_path(name): read_note(root, name) for name in called}, *called):
                found[part] = said
        return found

    @cached_property
    def _diffs(self) -> CommitDiffs:
        return CommitDiffs(self.folder)

    def _picked(self) -> Iterator[Commit]:
        """Yield the commits that git picks, their parents as git rewrites them."""
        arguments = self._arguments()
        if arguments is None:
            return
        self.repository.complete()
        lines = git.stream(self.repository.root, arguments, doing="list commits")
        sizes = chain(_BATCHES[:-1], iter(lambda: _BATCHES[-1], None))
        for size in sizes:
            batch = [line.split() for line in islice(lines, size)]
            if not batch:
                return
            known = self.repository.commits([name for name, *_ in batch])
            self._real |= known
            for name, *parents in batch:
                yield replace(known[name], parents=tuple(parents))

    def _arguments(self) -> list[str] | None:
        head = self.repository.head().commit
        if head is None and not self.asked.every and not self.asked.revisions:
            return None
        tips = (
            for_rev_list(self.repository, self.asked.revisions) if self.asked.revisions or not self.asked.every else []
        )
        tips += ["--branches", "--tags", "--remotes", *(["HEAD"] if head else [])] if self.asked.every else []
        order = ["--topo-order"] if self.asked.topological else []
        inside = self.repository.relative(self.folder.root)
        named = [p for p in self.asked.scope.paths if p != "."]
        paths = [f"{inside}/{p}" if inside else p for p in named] or ([inside] if inside else [])
        return [
            "rev-list",
            "--parents",
            *order,
            *self.asked.options,
            *tips,
            "--",
            *(f":(top,literal){p}" for p in paths),
        ]

    def _about(self, commits: Iterator[Commit]) -> Iterator[Commit]:
        """Yield the commits that changed what the scope names; in a graph, what is left out is bridged."""
        graph = self.asked.topological
        found = False
        for commit in bridged(list(commits), self._concerns) if graph else filter(self._concerns, commits):
            found = True
            yield commit
        if not found and (wrong := unknown_parts(self.folder, self.asked.scope)):
            raise PicoError(wrong)

    def _concerns(self, commit: Commit) -> bool:
        """Whether a commit changed what the scope names, against each of its parents."""
        entry = self._read(commit)
        keep = entry.shallow or (
            bool(entry.changes) and all(self._differs(p, commit.id) for p in self._real[commit.id].parents[1:])
        )
        if keep:
            self._entries[commit.id] = entry
        return keep

    def _differs(self, parent: str, commit: str) -> bool:
        try:
            changes = self._diffs.changes(parent, commit, names=self.asked.scope.parts)
        except PicoError:
            return True
        return bool(self._narrowed(changes, parent, commit))

    def _read(self, shown: Commit) -> CommitEntry:
        commit = self._real[shown.id]
        entry = self._diffs.entry(commit, names=self.asked.scope.parts)
        return replace(entry, changes=self._narrowed(entry.changes, *commit.parents[:1], commit.id))

    def _narrowed(self, changes: tuple[Change, ...], *commits: str) -> tuple[Change, ...]:
        scope = self.asked.scope
        if not scope or not changes:
            return changes
        held = {n for c in commits for p in scope.paths for n in self._diffs.components_of(c, p)}
        return scope.keep(changes, held)


def bridged(commits: list[Commit], wanted: Callable[[Commit], bool]) -> list[Commit]:
    """Return the wanted ones of commits (children before parents), each with the nearest wanted ones as parents."""
    stands: dict[str, tuple[str, ...]] = {}  # a commit -> itself, or what stands for it
    kept = []
    for commit in reversed(commits):
        parents = tuple(dict.fromkeys(name for p in commit.parents for name in stands.get(p, (p,))))
        if wanted(commit):
            stands[commit.id] = (commit.id,)
            kept.append(replace(commit, parents=parents))
        else:
            stands[commit.id] = parents
    return kept[::-1]
