"""Merging a branch as `pico merge` does: the result is computed, checked and only then written."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.history.git import command as git
from pico.history.git.commit import Commit
from pico.history.git.shallow import cut_off
from pico.history.git.unread import read_tree
from pico.history.lab.folder import LabFolder, edited
from pico.history.lab.notes import is_note
from pico.history.merge.markers import Labels
from pico.history.merge.trees import Union, opened, unite_commits
from pico.history.messages.trailers import EVIDENCE, LAB, STATE, with_trailers
from pico.history.writing.claim import Goal
from pico.history.writing.commit_object import NewCommit
from pico.history.writing.in_progress import refuse_begun
from pico.manifest.checks.required_version import require_satisfied
from pico.manifest.file_names import is_manifest
from pico.manifest.load import Manifests, load_files
from pico.model.diff import Change
from pico.model.record import record

Check = Callable[[Manifests], tuple[Diagnostic, ...]]
"""Says what is physically wrong with a state: errors refuse the merge."""


@record
class MergeMade:
    """A merge that was made: what came of it, the commit at HEAD now, and what that changed on the table here."""

    kind: Literal["merged", "fast-forward", "up-to-date"]
    commit: str
    name: str
    changes: tuple[Change, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()


def merge_revision(folder: LabFolder, revision: str, check: Check, message: str = "") -> MergeMade:
    """Merge a revision into the branch that is checked out, and return what came of it.

    `check` judges the merged state before anything is written. Raises PicoError, with nothing written: for edits that
    are not committed, for values that both sides changed, and (exit 3) for a state that can't stand.
    """
    repository = folder.history()
    ours, theirs = repository.resolve("HEAD"), repository.resolve(revision)
    _refuse_unfit(folder)
    handle = opened(repository.root)
    base = handle.merge_base(ours.id, theirs.id)
    if base is None and handle.is_shallow:
        raise PicoError(cut_off(handle, f"does not reach back to a commit that {revision} and HEAD have in common"))
    if base is None:
        hint = "`git merge --allow-unrelated-histories` does it all the same"
        raise PicoError(error("unrelated", f"{revision} and HEAD have no commit in common", hint=hint))
    if str(base) == theirs.id:
        return MergeMade(kind="up-to-date", commit=ours.id, name=revision)
    ahead = str(base) == ours.id
    labels = Labels(label_of(ours), str(base)[:7], label_of(theirs, revision))
    union = Union(str(handle[theirs.id].tree.id)) if ahead else unite_commits(handle, ours.id, theirs.id, labels)
    if union.conflicts or union.files:
        raise PicoError(refusals(union, labels, revision, (ours, theirs)))
    manifests = manifests_in(folder, handle, union.tree, f"{labels.ours}+{labels.theirs}")
    text = f"{labels.ours} and {labels.theirs} merge as text, but not on the table: nothing was written"
    found = (*coupled_warnings(union, labels), *judged(manifests, check, text))
    doing = f"pico merge {revision}"
    if ahead:
        repository.go(Goal(theirs.id, f"merge {revision}: Fast-forward"), doing=doing)
        git.notify(repository.root, "post-merge", "0")
    else:
        text = with_trailers(message.strip() or f"Merge {revision}", planned_trailers(manifests))
        repository.advance(
            [NewCommit(union.tree, text, (theirs.id,), name="the merge")],
            doing=doing,
            reason=f"merge {revision}: by PICO",
        )
    folder.reload()
    made = repository.resolve("HEAD")
    kind: Literal["merged", "fast-forward"] = "fast-forward" if ahead else "merged"
    return MergeMade(kind=kind, commit=made.id, name=revision, changes=folder.diff(ours.id, made.id), diagnostics=found)


def label_of(commit: Commit, revision: str = "") -> str:
    """Return what to call a commit: as the user called it, else a name at it or its short id."""
    return commit.label if revision in ("", commit.id, commit.label) else revision


def _refuse_unfit(folder: LabFolder) -> None:
    """Raise PicoError where manifests or notes are edited, or where git has begun something else here. Other files that
    are edited, and that the merge changes, git refuses to overwrite."""
    root, inside = folder.history().root, folder.history().relative(folder.root)
    refuse_begun(folder.history().own, "merge")
    listed = git.run(root, ["status", "--porcelain", "-z", "--untracked-files=no"], doing="list what was edited")
    names = tuple(entry[3:] for entry in listed.split("\0") if len(entry) > 3)
    paths = tuple(p for p in names if is_manifest(p) or is_note(p.removeprefix(f"{inside}/" if inside else "")))
    if paths:
        raise PicoError(edited(paths))


def refusals(union: Union, labels: Labels, revision: str, sides: tuple[Commit, Commit]) -> list[Diagnostic]:
    """Return what stands in the way of a merge of `revision`: each value that both sides changed, with both commits."""
    ours, theirs = (f"{name} ({side.short})" for name, side in zip((labels.ours, labels.theirs), sides, strict=True))
    hint = f"`git merge {revision}` writes both between markers; edit, `git add`, `pico commit`"
    apart = f"`git merge --no-commit {revision}`; then leave it in one file, or in none, `git add`, `pico commit`"
    found = [
        error(
            "merge-conflict",
            f"{c.address}: {ours} says {c.ours}, {theirs} says {c.theirs}",
            detail=f"in {path}; the common ancestor {labels.base} says {c.base}",
            address=c.address, hint=apart if c.files else hint,
        )
        for path, c in union.conflicts
    ]  # fmt: skip
    return found + [
        error("merge-conflict", f"{path}: {ours} and {theirs} changed it in ways that can't be united", hint=hint)
        for path in sorted(set(union.files))
    ]


def coupled_warnings(union: Union, labels: Labels) -> list[Diagnostic]:
    """Return a warning for each group of tunables of which both sides changed a part."""
    return [
        warning(
            "coupled",
            f"{c.component}: {labels.ours} changed {', '.join(c.ours)}, {labels.theirs} {', '.join(c.theirs)}",
            detail="they belong together, so the united values may be what nobody wanted",
            hint="look at it, and measure before you trust it; `policy: {merge: strict}` makes this a conflict",
            address=c.component,
        )
        for _, c in union.coupled
    ]


def manifests_in(folder: LabFolder, handle: Any, tree: str, name: str) -> Manifests:
    """Return the manifests of the lab in a tree; `name`: what diagnostics call it."""
    repository, found = folder.history(), list[Diagnostic]()
    files = read_tree(repository, handle[tree], repository.relative(folder.root), name, found)
    return load_files({f"{name}:{path}": data for path, data in files.items()}, found)


def planned_trailers(manifests: Manifests) -> list[tuple[str, str]]:
    """Return the trailers of a commit whose state was never on the bench."""
    setup, state = manifests.require()
    return [(STATE, state.digest()), (EVIDENCE, "planned"), (LAB, f"{setup.lab.name} {setup.digest()}")]


def judged(manifests: Manifests, check: Check, text: str) -> tuple[Diagnostic, ...]:
    """Return the warnings of a state that is about to be written.

    Raises PicoError, ending with `text`, where it is not valid or can't stand (exit 3), and PicoError (exit 1) if it
    requires another PICO.
    """
    require_satisfied(manifests.diagnostics)
    try:
        manifests.require()
    except PicoError as exc:
        raise PicoError([*exc.diagnostics, error("merge-impossible", text)], ExitCode.IMPOSSIBLE) from exc
    found = check(manifests)
    if any(d.severity == "error" for d in found):
        raise PicoError([*found, error("merge-impossible", text)], ExitCode.IMPOSSIBLE)
    return found
