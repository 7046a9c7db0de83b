"""A physical change taken back, or done once more on another branch: three-way on values, manifests and nothing else.

`git revert` also takes the files of runs that a commit carried out of the tip; here runs and notes stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.git import command as git
from pico.history.git.commit import Commit
from pico.history.git.shallow import boundary, cut_off
from pico.history.lab.folder import LabFolder, between
from pico.history.merge.commits import coupled_warnings, judged, label_of, manifests_in, planned_trailers
from pico.history.merge.trees import blobs, manifest_tree, opened, unite_trees, with_files
from pico.history.messages.trailers import with_trailers
from pico.history.repository.ranges import for_rev_list
from pico.history.restoring.messages import (
    cherry_message,
    conflicts,
    labels,
    mainline_needed,
    revert_message,
    rootless,
)  # fmt: skip
from pico.history.writing.claim import Goal
from pico.history.writing.commit_object import NewCommit
from pico.manifest.load import Manifests
from pico.model.diff import Change
from pico.model.record import record

Way = Literal["revert", "cherry-pick"]
Check = Callable[[Manifests, Manifests], tuple[Diagnostic, ...]]
"""Says what is physically wrong with a state, and with getting there from another one: errors refuse it."""


@record
class Transplanted:
    """What came of taking a change back (`revert`) or doing it once more (`cherry-pick`).

    `of`: the commit that made the change, `name` what it was called, `summary` its first line. `files`: the manifests
    that were written, none where there was nothing to do. `commit`: the one that was made, where one was. `changes`:
    what that changed on the table.
    """

    way: Way
    of: str
    name: str
    summary: str
    files: tuple[str, ...] = ()
    commit: str | None = None
    changes: tuple[Change, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True)
class _Step:
    """One change to be carried: who made it, against which parent, the manifests before and after it is carried, as
    trees, those after it as they read, and what it changes on the table."""

    way: Way
    commit: Commit
    name: str
    parent: Commit | None
    before: str
    after: str
    diagnostics: tuple[Diagnostic, ...] = ()
    manifests: Manifests | None = None
    changes: tuple[Change, ...] = ()

    @property
    def moves(self) -> bool:
        """Whether there is something to do."""
        return self.before != self.after


def revert(
    folder: LabFolder, revision: str, check: Check, *, message: str = "", mainline: int | None = None,
    commit: bool = True,
) -> Transplanted:  # fmt: skip
    """Take back what a revision changed in the manifests, as a new commit; later changes of other tunables stay.

    `mainline`: the parent, from 1, that a merge is compared with. Raises PicoError, with nothing written: for edits
    that are not committed, for tunables that were changed since, and (exit 3) for a state that can't stand.
    """
    (done,) = _carry(folder, [revision], "revert", check, mainline, message if commit else None)
    return done


def cherry_pick(
    folder: LabFolder, revisions: Sequence[str], check: Check, *, mainline: int | None = None, commit: bool = True
) -> tuple[Transplanted, ...]:
    """Do to the manifests what revisions, or ranges (`main..e1`), changed in them: a commit each, whose message and
    author stay. Nothing is written unless all of them can be. Raises PicoError as `revert` does.
    """
    each = [name for revision in revisions for name in _listed(folder, revision)]
    return tuple(_carry(folder, each, "cherry-pick", check, mainline, "" if commit else None))


def _carry(
    folder: LabFolder, revisions: Sequence[str], way: Way, check: Check, mainline: int | None, message: str | None
) -> list[Transplanted]:
    """Compute every step in memory, then write all of them or none; `message` is None where nothing is committed."""
    with folder.writing(f"pico {way}"):
        folder.refuse_edits(way)
        return _write(folder, _steps(folder, revisions, way, check, mainline), way, message)


def _steps(folder: LabFolder, revisions: Sequence[str], way: Way, check: Check, mainline: int | None) -> list[_Step]:
    repository = folder.history()
    handle = opened(repository.root)
    head = repository.resolve("HEAD")
    onto = manifest_tree(handle, handle[head.id].tree, repository.relative(folder.root))
    steps: list[_Step] = []
    for revision in revisions:
        steps.append(_step(folder, handle, head, steps[-1].after if steps else onto, revision, way, mainline, check))
    return steps


def _listed(folder: LabFolder, revision: str) -> list[str]:
    """Return the commits of a range, oldest first, or the one revision."""
    if ".." not in revision:
        return [revision]
    arguments = ["rev-list", "--reverse", *for_rev_list(folder.history(), (revision,)), "--"]
    return git.run(folder.history().root, arguments, doing=f"list the commits of {revision}").split()


def _step(
    folder: LabFolder, handle: Any, head: Commit, onto: str, revision: str, way: Way, mainline: int | None,
    check: Check,
) -> _Step:  # fmt: skip
    repository = folder.history()
    inside = repository.relative(folder.root)
    commit = repository.resolve(revision)
    name = commit.short if revision.startswith(("HEAD", "@")) else label_of(commit, revision)
    if commit.id in boundary(repository.common):
        raise PicoError(cut_off(handle, f"does not have the commit before {name}, which says what {name} changed"))
    parent = _parent(folder, commit, name, mainline)
    made = manifest_tree(handle, handle[commit.id].tree, inside)
    was = manifest_tree(handle, handle[parent.id].tree if parent else None, inside)
    empty = manifest_tree(handle, None, inside)
    if made == empty:
        hint = "the lab may have had another folder then"
        raise PicoError(error("revision", f"{name} has no lab in {inside or 'the repository'}", hint=hint))
    if way == "revert" and was == empty:
        raise PicoError(rootless(name))
    base, theirs = (made, was) if way == "revert" else (was, made)
    called = labels(way, head, name)
    union = unite_trees(handle, base, onto, theirs, called)
    if union.conflicts or union.files:
        raise PicoError(conflicts(handle, union, way, (head, onto), (name, commit), parent))
    if union.tree == onto:
        return _Step(way, commit, name, parent, onto, onto)
    manifests = manifests_in(folder, handle, union.tree, f"{called.ours}+{called.theirs}")
    before = manifests_in(folder, handle, onto, called.ours)
    text = f"{called.ours} and {called.theirs} unite as text, but not on the table: nothing was written"
    found = judged(manifests, lambda wanted: check(wanted, before), text)
    told = (*coupled_warnings(union, called), *found)
    return _Step(way, commit, name, parent, onto, union.tree, told, manifests, _changes(before, manifests))


def _parent(folder: LabFolder, commit: Commit, name: str, mainline: int | None) -> Commit | None:
    """Return what a commit's change is against; raises PicoError for a merge without a side that counts."""
    sides = [folder.history().resolve(p) for p in commit.parents]
    if (mainline is None and len(sides) > 1) or (mainline is not None and not 1 <= mainline <= len(sides)):
        raise PicoError(mainline_needed(name, sides, mainline))
    return sides[(mainline or 1) - 1] if sides else None


def _write(folder: LabFolder, steps: Sequence[_Step], way: Way, message: str | None) -> list[Transplanted]:
    """Write what the steps change, and commit that and nothing else, each for itself."""
    repository, moving = folder.history(), [s for s in steps if s.moves]
    doing = f"pico {way} {' '.join(s.name for s in moving)}"
    made: Sequence[Commit] = ()
    if moving and message is None:
        repository.go(Goal(tree=_whole(folder, moving[-1])), doing=f"{doing} --no-commit")
    elif moving:
        wanted = [_commit(folder, step, message or "") for step in moving]
        made = repository.advance(wanted, doing=doing, reason=f"{way}: {wanted[-1].message.partition(chr(10))[0]}")
    folder.reload()
    each = iter(made)
    return [_done(folder, step, next(each, None) if step.moves else None) for step in steps]


def _done(folder: LabFolder, step: _Step, made: Commit | None) -> Transplanted:
    handle = opened(folder.history().root)
    old, new = (blobs(handle[tree]) for tree in (step.before, step.after))
    return Transplanted(
        way=step.way, of=step.commit.id, name=step.name, summary=step.commit.summary, diagnostics=step.diagnostics,
        files=tuple(sorted(p for p in old.keys() | new.keys() if old.get(p) != new.get(p))),
        commit=made.id if made else None, changes=folder.entry(made).changes if made else step.changes,
    )  # fmt: skip


def _changes(before: Manifests, after: Manifests) -> tuple[Change, ...]:
    try:
        return between(before.require(), after.require())
    except PicoError:  # what was there before can't be read
        return ()


def _commit(folder: LabFolder, step: _Step, message: str) -> NewCommit:
    assert step.manifests is not None
    if step.way == "revert":
        text, author = revert_message(step.commit, step.parent, message), None
    else:
        text, author = cherry_message(step.commit), (step.commit.author, step.commit.time)
    return NewCommit(
        _whole(folder, step), with_trailers(text, planned_trailers(step.manifests)), author=author, name=step.name
    )


def _whole(folder: LabFolder, step: _Step) -> str:
    """Return the tree of HEAD with the manifests as they are after a step."""
    handle, head = opened(folder.history().root), folder.history().resolve("HEAD")
    tree, inside = handle[head.id].tree, folder.history().relative(folder.root)
    return with_files(handle, tree, manifest_tree(handle, tree, inside), step.after)
