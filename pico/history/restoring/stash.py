"""git's stash for the manifests of a lab. It shelves files; the bench is not shelved, and nothing moves."""

from __future__ import annotations

import re
from collections.abc import Sequence

from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.git import command as git
from pico.history.lab.folder import LabFolder
from pico.history.merge.markers import Labels
from pico.history.merge.trees import manifest_tree, opened, unite_trees, with_files
from pico.history.writing.claim import Goal
from pico.history.writing.in_progress import refuse_begun
from pico.model.diff import Change
from pico.model.record import record

_NAMED = re.compile(r"(?:stash@\{)?(\d+)\}?")
_LONGEST = 72


@record
class Shelf:
    """Edits that are shelved: their place in the stash (0 is the last), the commit that holds them, what git calls
    them, and what they change on the table against the commit that they were made on."""

    number: int
    commit: str
    message: str
    changes: tuple[Change, ...] = ()


class Stash:
    """The stash of the repository around a lab."""

    def __init__(self, folder: LabFolder) -> None:
        self.folder = folder
        self.repository = folder.history()

    def shelves(self) -> tuple[Shelf, ...]:
        """Return what is shelved, the last first."""
        listed = git.run(self.repository.root, ["stash", "list", "--format=%H%x00%gs"], doing="list the stash")
        pairs = [line.split("\0") for line in listed.splitlines()]
        return tuple(
            Shelf(number=i, commit=commit, message=said, changes=self._changes(commit))
            for i, (commit, said) in enumerate(pairs)
        )

    def push(self, message: str = "") -> Shelf | None:
        """Shelve the edits of the manifests, new files too; None where there are none. Raises PicoError.

        `message`: what to call them; without it what they change on the table.
        """
        with self.folder.writing("pico stash"):
            refuse_begun(self.repository.own, "stash")  # what was merged would go, and the mark that it was would stay
            return self._push(message)

    def _push(self, message: str) -> Shelf | None:
        paths = self.repository.changed(self.folder.root)
        if not paths:
            return None
        changes = self.folder.diff("HEAD")
        said = message.strip() or _said(changes)
        self.repository.shelve(paths, said, doing="pico stash")
        self.folder.reload()
        shelf = self.shelves()[0]
        return Shelf(number=0, commit=shelf.commit, message=shelf.message, changes=changes)

    def pop(self, name: str = "") -> Shelf:
        """Bring shelved edits back into the manifests (the last ones without a `name` such as `1`).

        Raises PicoError, the edits still shelved and nothing written, where a tunable was changed since they were
        shelved.
        """
        shelf = self._find(name)
        with self.folder.writing("pico stash pop"):
            refuse_begun(self.repository.own, "stash pop")
            self.repository.go(Goal(tree=self._united(shelf), shelf=shelf.commit), doing="pico stash pop")
            self.folder.reload()
        return shelf

    def drop(self, name: str = "") -> Shelf:
        """Throw shelved edits away; git keeps the commit for a while. Raises PicoError."""
        shelf = self._find(name)
        git.run(self.repository.root, ["stash", "drop", "--quiet", f"stash@{{{shelf.number}}}"], doing="drop the edits")
        return shelf

    def _find(self, name: str) -> Shelf:
        shelves = self.shelves()
        match = _NAMED.fullmatch(name or "0")
        number = int(match[1]) if match else -1
        if 0 <= number < len(shelves):
            return shelves[number]
        if not shelves:
            raise PicoError(
                error("stash", "nothing is shelved", hint="`pico stash` shelves the edits of the manifests")
            )
        hint = "`pico stash list` shows them: 0 is the last"
        raise PicoError(error("stash", f"there are no shelved edits `{name}`", hint=hint))

    def _changes(self, commit: str) -> tuple[Change, ...]:
        try:
            return self.folder.diff(f"{commit}^1", commit)
        except PicoError:  # shelved before there was a lab, or unreadable
            return ()

    def _united(self, shelf: Shelf) -> str:
        """Return the tree of HEAD with the shelved edits done to it, new files too.

        Raises PicoError naming each tunable that the shelved edits and HEAD say otherwise.
        """
        handle = opened(self.repository.root)
        shelved, head = handle[shelf.commit], self.repository.resolve("HEAD")
        base, ours, nothing = shelved.parents[0].tree, handle[head.id].tree, manifest_tree(handle, None, "")
        new = str(shelved.parents[2].tree.id) if len(shelved.parents) > 2 else nothing  # files that git did not know
        theirs = with_files(handle, shelved.tree, nothing, new)
        labels = Labels(head.label, shelved.parents[0].short_id, "the shelved edits")
        union = unite_trees(handle, str(base.id), str(ours.id), theirs, labels)
        hint = "`git stash pop` writes both between markers; the edits are still shelved"
        found: list[Diagnostic] = [
            error(
                "stash-conflict",
                f"{c.address}: the shelved edits say {c.theirs}, {head.label} says {c.ours}",
                detail=f"in {path}; when they were shelved it was {c.base}", address=c.address, hint=hint,
            )
            for path, c in union.conflicts
        ]  # fmt: skip
        found += [
            error("stash-conflict", f"{path} was changed since in a way that can't be united", hint=hint)
            for path in sorted(set(union.files))
        ]
        if found:
            raise PicoError(found)
        return union.tree


def _said(changes: Sequence[Change]) -> str:
    """Return changes in one line, for the list of what is shelved; empty for none."""
    names = [c.component if c.tunable == "pose" else f"{c.component}.{c.tunable}" for c in changes]
    words = ", ".join(f"{name} {c.text}" for name, c in zip(names, changes, strict=True))
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST - 1]}…"
