"""Merging a branch as `pico merge` does: the result is computed, checked and only then written, by the user's `git`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error, warning
from pico.history import git
from pico.history.commit import Commit
from pico.history.folder import LabFolder
from pico.history.merge import Merged, merge
from pico.history.merge_groups import groups_of
from pico.history.merge_leaves import Conflict, Coupled
from pico.history.merge_markers import Labels
from pico.history.trees import is_manifest
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


@dataclass
class Union:
    """Two commits united in memory: the tree's id, and what stands in the way."""

    tree: str = ""
    conflicts: list[tuple[str, Conflict]] = field(default_factory=list)
    coupled: list[tuple[str, Coupled]] = field(default_factory=list)
    files: list[str] = field(default_factory=list)


def merge_revision(folder: LabFolder, revision: str, check: Check, message: str = "") -> MergeMade:
    """Merge a revision into the branch that is checked out, and return what came of it.

    `check` judges the merged state before anything is written. Raises PicoError, with nothing written: for edits that
    are not committed, for values that both sides changed, and (exit 3) for a state that can't stand.
    """
    repository = folder.history()
    ours, theirs = repository.resolve("HEAD"), repository.resolve(revision)
    _refuse_unfit(folder)
    handle = _handle(repository.root)
    base = handle.merge_base(ours.id, theirs.id)
    if base is None:
        hint = "`git merge --allow-unrelated-histories` does it all the same"
        raise PicoError(error("unrelated", f"{revision} and HEAD have no commit in common", hint=hint))
    if str(base) == theirs.id:
        return MergeMade(kind="up-to-date", commit=ours.id, name=revision)
    ahead = str(base) == ours.id
    labels = Labels(_label(ours), str(base)[:7], _label(theirs, revision))
    union = Union(str(handle[theirs.id].tree.id)) if ahead else unite(handle, ours.id, theirs.id, labels)
    if union.conflicts or union.files:
        raise PicoError(_refusals(union, labels, revision, (ours, theirs)))
    manifests = _manifests(folder, handle, union.tree, f"{labels.ours}+{labels.theirs}")
    found = (*_warnings(union, labels), *_judged(manifests, check, labels))
    if ahead:
        git.run(repository.root, ["merge", "--ff-only", "--quiet", theirs.id], doing=f"go to {revision}")
    else:
        state = manifests.require()[1].digest()
        text = message.strip() or f"Merge {revision}"
        _write(repository.root, union.tree, theirs.id, f"{text}\n\nPico-State: {state}\nPico-Evidence: planned\n")
    folder.reload()
    made = repository.resolve("HEAD")
    kind: Literal["merged", "fast-forward"] = "fast-forward" if ahead else "merged"
    return MergeMade(kind=kind, commit=made.id, name=revision, changes=folder.diff(ours.id, made.id), diagnostics=found)


def unite(handle: Any, ours: str, theirs: str, labels: Labels) -> Union:
    """Merge two commits in memory: libgit2 unites the trees, and every file that both changed is merged by value."""
    union = Union()
    index = handle.merge_commits(ours, theirs)
    trees = [handle[str(handle.merge_base(ours, theirs))].tree, handle[ours].tree, handle[theirs].tree]
    groups, strict = groups_of(_contents(handle, trees[1]).items())
    for path, blobs in _both_changed(trees, index):
        was, mine, other = (handle[b].data if b else None for b in blobs)
        if mine is None or other is None:
            union.files.append(path)
            continue
        merged = merge(was, mine, other, labels=labels, groups=groups, strict=strict)
        _note(union, path, merged)
        if merged.clean:
            _store(handle, index, path, merged.data, trees[1])
    if not union.conflicts and not union.files:
        union.tree = str(index.write_tree(handle))
    return union


def _both_changed(trees: list[Any], index: Any) -> list[tuple[str, tuple[Any, Any, Any]]]:
    """Return the files that both sides changed otherwise, with their blobs in base, ours and theirs."""
    found: dict[str, tuple[Any, Any, Any]] = {}
    for entries in list(index.conflicts or ()):
        path = next(e.path for e in (entries[1], entries[2], entries[0]) if e)
        was, mine, other = (e.id if e else None for e in entries)
        found[path] = (was, mine, other)
    before, here, there = (_blobs(tree) for tree in trees)
    for path in here.keys() & there.keys():
        if is_manifest(path) and path not in found and len({before.get(path), here[path], there[path]}) == 3:
            found[path] = (before.get(path), here[path], there[path])
    return sorted(found.items())


def _blobs(tree: Any, at: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for entry in tree:
        if entry.type_str == "tree":
            found |= _blobs(entry, f"{at}{entry.name}/")
        elif entry.type_str == "blob":
            found[at + entry.name] = entry.id
    return found


def _contents(handle: Any, tree: Any) -> dict[str, bytes]:
    return {path: handle[blob].data for path, blob in _blobs(tree).items() if is_manifest(path)}


def _store(handle: Any, index: Any, path: str, data: bytes, ours: Any) -> None:
    import pygit2

    mode = ours[path].filemode if path in ours else pygit2.enums.FileMode.BLOB
    if index.conflicts is not None and path in index.conflicts:
        del index.conflicts[path]
    index.add(pygit2.IndexEntry(path, handle.create_blob(data), mode))


def _note(union: Union, path: str, merged: Merged) -> None:
    union.conflicts += [(path, c) for c in merged.conflicts]
    union.coupled += [(path, c) for c in merged.coupled]
    if not merged.clean and not merged.conflicts:
        union.files.append(path)


def _handle(root: Path) -> Any:
    import pygit2

    return pygit2.Repository(str(root))


def _label(commit: Commit, revision: str = "") -> str:
    return commit.label if revision in ("", commit.id, commit.label) else revision


def _refuse_unfit(folder: LabFolder) -> None:
    """Raise PicoError where edits would be lost, or where another merge has not come to its end."""
    root = folder.history().root
    listed = git.run(root, ["status", "--porcelain", "-z", "--untracked-files=no"], doing="list what was edited")
    if listed:
        paths = [entry[3:] for entry in listed.split("\0") if len(entry) > 3]
        text = f"{', '.join(paths[:3])}{' and others' if len(paths) > 3 else ''} differ from the last commit"
        hint = '`pico commit -m "why"` keeps the edits, `git stash` shelves them, `git restore .` drops them'
        raise PicoError(error("edited", text, hint=hint))


def _refusals(union: Union, labels: Labels, revision: str, sides: tuple[Commit, Commit]) -> list[Diagnostic]:
    ours, theirs = (f"{name} ({side.short})" for name, side in zip((labels.ours, labels.theirs), sides, strict=True))
    hint = f"`git merge {revision}` writes both between markers; edit, `git add`, `git commit`"
    found = [
        error(
            "merge-conflict",
            f"{c.address}: {ours} says {c.ours}, {theirs} says {c.theirs}",
            detail=f"in {path}; {labels.base}, which both come from, says {c.base}",
            address=c.address, hint=hint,
        )
        for path, c in union.conflicts
    ]  # fmt: skip
    return found + [
        error("merge-conflict", f"{path}: {ours} and {theirs} changed it in ways that can't be united", hint=hint)
        for path in sorted(set(union.files))
    ]


def _warnings(union: Union, labels: Labels) -> list[Diagnostic]:
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


def _manifests(folder: LabFolder, handle: Any, tree: str, name: str) -> Manifests:
    inside = folder.history().relative(folder.root)
    top = handle[tree][inside] if inside else handle[tree]
    files: Mapping[str, bytes] = _contents(handle, top)
    return load_files({f"{name}:{path}": data for path, data in files.items()})


def _judged(manifests: Manifests, check: Check, labels: Labels) -> tuple[Diagnostic, ...]:
    """Return the warnings of a merged state; raises PicoError where it is not valid or can't stand."""
    manifests.require()
    found = check(manifests)
    if any(d.severity == "error" for d in found):
        text = f"{labels.ours} and {labels.theirs} merge as text, but not on the table: nothing was written"
        raise PicoError([*found, error("merge-impossible", text)], ExitCode.IMPOSSIBLE)
    return found


def _write(root: Path, tree: str, theirs: str, message: str) -> None:
    """Write the merge commit: git records whom it merges, then takes the tree, then commits with hooks and signature.

    Cut short between these, what is left is a merge to be ended by `git commit` or `git merge --abort`.
    """
    start = ["merge", "--quiet", "--no-ff", "--no-commit", "--strategy=ours", theirs]
    git.run(root, start, doing="begin the merge")
    try:
        git.run(root, ["read-tree", "-m", "-u", "HEAD", tree], doing="write the merged files")
        hooks = "pre-commit pre-merge-commit commit-msg prepare-commit-msg"
        git.run(root, ["commit", "--quiet", "--file=-"], doing="commit the merge", stdin=message, hook=hooks)
    except PicoError:
        git.run(root, ["merge", "--abort"], doing="take the merge back")
        raise
