"""A physical change taken back, or done once more on another branch: three-way on values, manifests and nothing else.

`git revert` also takes the files of runs that a commit carried out of the tip; here runs and notes stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

from pico.diagnostics import Diagnostic, PicoError, error
from pico.history import git
from pico.history.carry_words import (
    cherry_message,
    conflicts,
    half_done,
    labels,
    mainline_needed,
    revert_message,
    rootless,
)  # fmt: skip
from pico.history.commit import Commit
from pico.history.folder import LabFolder
from pico.history.merge.commits import coupled_warnings, judged, label_of, manifests_in, planned_trailers
from pico.history.merge.trees import blobs, manifest_tree, opened, unite_trees
from pico.history.writing.files import write_files
from pico.history.writing.trailers import with_trailers
from pico.history.writing.underway import underway
from pico.manifest.load import Manifests
from pico.model.diff import Change
from pico.model.record import record

Way = Literal["revert", "cherry-pick"]
Check = Callable[[Manifests, Manifests], tuple[Diagnostic, ...]]
"""Says what is physically wrong with a state, and with getting there from another one: errors refuse it."""


@record
class Carried:
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
    """One change to be carried: who made it, against which parent, and the manifests before and after it is carried."""

    way: Way
    commit: Commit
    name: str
    parent: Commit | None
    before: str
    after: str
    diagnostics: tuple[Diagnostic, ...] = ()


def revert(
    folder: LabFolder, revision: str, check: Check, *, message: str = "", mainline: int | None = None,
    commit: bool = True,
) -> Carried:  # fmt: skip
    """Take back what a revision changed in the manifests, as a new commit; later changes of other tunables stay.

    `mainline`: the parent, from 1, that a merge is compared with. Raises PicoError, with nothing written: for edits
    that are not committed, for tunables that were changed since, and (exit 3) for a state that can't stand.
    """
    (done,) = _carry(folder, [revision], "revert", check, mainline, message if commit else None)
    return done


def cherry_pick(
    folder: LabFolder, revisions: Sequence[str], check: Check, *, mainline: int | None = None, commit: bool = True
) -> tuple[Carried, ...]:
    """Do to the manifests what revisions, or ranges (`main..e1`), changed in them: a commit each, whose message and
    author stay. Nothing is written unless all of them can be. Raises PicoError as `revert` does.
    """
    each = [name for revision in revisions for name in _listed(folder, revision)]
    return tuple(_carry(folder, each, "cherry-pick", check, mainline, "" if commit else None))


def _carry(
    folder: LabFolder, revisions: Sequence[str], way: Way, check: Check, mainline: int | None, message: str | None
) -> list[Carried]:
    """Compute every step in memory, then write; `message` is None where nothing is to be committed."""
    with folder.writing(f"pico {way}"):
        _refuse_unfit(folder, way)
        done: list[Carried] = []
        for step in _steps(folder, revisions, way, check, mainline):
            try:
                done.append(_write(folder, step, message))
            except PicoError as exc:
                raise PicoError([*exc.diagnostics, *half_done([d.name for d in done if d.commit])]) from exc
        return done


def _refuse_unfit(folder: LabFolder, way: Way) -> None:
    """Raise PicoError where edits would be lost, or where git has begun something else here."""
    begun = underway(folder.history().own)
    if begun not in ("", "rebase"):
        hint = f"`pico commit` ends it, `git {begun} --abort` takes it back"
        raise PicoError(error("git-merging", f"a {begun} is under way: no {way} before it has ended", hint=hint))
    folder.refuse_edits()


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
    arguments = ["rev-list", "--reverse", "--end-of-options", revision, "--"]
    return git.run(folder.history().root, arguments, doing=f"list the commits of {revision}").split()


def _step(
    folder: LabFolder, handle: Any, head: Commit, onto: str, revision: str, way: Way, mainline: int | None,
    check: Check,
) -> _Step:  # fmt: skip
    repository = folder.history()
    inside = repository.relative(folder.root)
    commit = repository.resolve(revision)
    name = commit.short if revision.startswith(("HEAD", "@")) else label_of(commit, revision)
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
    return _Step(way, commit, name, parent, onto, union.tree, (*coupled_warnings(union, called), *found))


def _parent(folder: LabFolder, commit: Commit, name: str, mainline: int | None) -> Commit | None:
    """Return what a commit's change is against; raises PicoError for a merge without a side that counts."""
    sides = [folder.history().resolve(p) for p in commit.parents]
    if (mainline is None and len(sides) > 1) or (mainline is not None and not 1 <= mainline <= len(sides)):
        raise PicoError(mainline_needed(name, sides, mainline))
    return sides[(mainline or 1) - 1] if sides else None


def _write(folder: LabFolder, step: _Step, message: str | None) -> Carried:
    """Write what a step changes, and commit that and nothing else; where git refuses, the files are put back."""
    done = Carried(
        way=step.way, of=step.commit.id, name=step.name, summary=step.commit.summary, diagnostics=step.diagnostics
    )
    if step.before == step.after:
        return done
    root, scratch = folder.history().root, folder.root / ".pico"
    handle = opened(root)
    old, new = (blobs(handle[tree]) for tree in (step.before, step.after))
    paths = sorted(p for p in old.keys() | new.keys() if old.get(p) != new.get(p))
    _refuse_ignored(root, [p for p in paths if p not in old])
    write_files(root, {p: handle[new[p]].data if p in new else None for p in paths}, scratch)
    folder.reload()
    changes = folder.diff("HEAD") if message is None else ()
    made = None
    if message is not None:
        try:
            made = _commit(folder, step, paths, message)
        except PicoError:
            write_files(root, {p: handle[old[p]].data if p in old else None for p in paths}, scratch)
            folder.reload()
            raise
        changes = folder.entry(made).changes
    return replace(done, files=tuple(paths), commit=made.id if made else None, changes=changes)


def _refuse_ignored(root: Any, paths: Sequence[str]) -> None:
    there = [path for path in paths if (root / path).exists()]
    if there:
        text = f"{', '.join(there)} would be overwritten, and git does not keep it"
        raise PicoError(error("exists", text, hint="move it away, or commit it (`git add -f`)"))


def _commit(folder: LabFolder, step: _Step, paths: Sequence[str], message: str) -> Commit:
    if step.way == "revert":
        text, author = revert_message(step.commit, step.parent, message), None
    else:
        text, author = cherry_message(step.commit), (step.commit.author, step.commit.time)
    text = with_trailers(text, planned_trailers(folder.manifests))
    return folder.history().commit(paths, text, author=author)
