"""Three trees of manifests merged in memory: every file that both sides changed is merged by value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pico.history.merge.groups import groups_of
from pico.history.merge.leaves import Conflict, Coupled
from pico.history.merge.manifests import Merged, merge
from pico.history.merge.markers import Labels
from pico.history.trees import entries, is_manifest


@dataclass
class Union:
    """What came of a merge in memory: the tree's id, and by path what stands in the way."""

    tree: str = ""
    conflicts: list[tuple[str, Conflict]] = field(default_factory=list)
    coupled: list[tuple[str, Coupled]] = field(default_factory=list)
    files: list[str] = field(default_factory=list)


def opened(root: Path) -> Any:
    """Return the repository at `root` as libgit2 holds it."""
    import pygit2

    return pygit2.Repository(str(root))


def unite_commits(handle: Any, ours: str, theirs: str, labels: Labels) -> Union:
    """Merge two commits over what both come from: libgit2 unites the trees, PICO the manifests that both changed."""
    index = handle.merge_commits(ours, theirs)
    trees = [handle[str(handle.merge_base(ours, theirs))].tree, handle[ours].tree, handle[theirs].tree]
    return _united(handle, index, trees, labels)


def unite_trees(handle: Any, base: str, ours: str, theirs: str, labels: Labels) -> Union:
    """Do to the tree `ours` what leads from the tree `base` to `theirs`, value by value."""
    index = handle.merge_trees(*(handle[name] for name in (base, ours, theirs)))
    return _united(handle, index, [handle[name] for name in (base, ours, theirs)], labels)


def manifest_tree(handle: Any, tree: Any, folder: str) -> str:
    """Write a tree with the manifests of `tree` (None: of nothing) below `folder`, at their paths; return its id."""
    import pygit2

    index = pygit2.Index()
    top = _below(tree, folder) if tree is not None else None
    for path, entry in _entries(top, f"{folder}/" if folder else "") if top is not None else ():
        if is_manifest(path):
            index.add(pygit2.IndexEntry(path, entry.id, entry.filemode))
    return str(index.write_tree(handle))


def with_files(handle: Any, tree: Any, out: str, into: str) -> str:
    """Write a tree as `tree`, without the files of the tree `out` and with those of the tree `into`; return its id."""
    import pygit2

    index = pygit2.Index()
    index.read_tree(tree)
    for path in blobs(handle[out]):
        index.remove(path)
    for path, entry in _entries(handle[into]):
        index.add(pygit2.IndexEntry(path, entry.id, entry.filemode))
    return str(index.write_tree(handle))


def contents(handle: Any, tree: Any) -> dict[str, bytes]:
    """Return the manifests of a tree by path."""
    return {path: handle[blob].data for path, blob in blobs(tree).items() if is_manifest(path)}


def blobs(tree: Any) -> dict[str, Any]:
    """Return the ids of the files of a tree by path."""
    return {path: entry.id for path, entry in _entries(tree)}


def _below(tree: Any, folder: str) -> Any:
    try:
        found = tree[folder] if folder else tree
    except KeyError:
        return None
    return found if found.type_str == "tree" else None


def _entries(tree: Any, at: str = "") -> list[tuple[str, Any]]:
    from pygit2.enums import FileMode

    return [(at + p, e) for p, e in entries(tree) if e.type_str == "blob" and e.filemode != FileMode.LINK]


def _united(handle: Any, index: Any, trees: Sequence[Any], labels: Labels) -> Union:
    union = Union()
    groups, strict = groups_of(contents(handle, trees[1]).items())
    for path, versions in _both_changed(trees, index):
        was, mine, other = (handle[b].data if b else None for b in versions)
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


def _both_changed(trees: Sequence[Any], index: Any) -> list[tuple[str, tuple[Any, Any, Any]]]:
    """Return the files that both sides changed otherwise, with their blobs in base, ours and theirs."""
    found: dict[str, tuple[Any, Any, Any]] = {}
    for sides in list(index.conflicts or ()):
        path = next(e.path for e in (sides[1], sides[2], sides[0]) if e)
        was, mine, other = (e.id if e else None for e in sides)
        found[path] = (was, mine, other)
    before, here, there = (blobs(tree) for tree in trees)
    for path in here.keys() & there.keys():
        if is_manifest(path) and path not in found and len({before.get(path), here[path], there[path]}) == 3:
            found[path] = (before.get(path), here[path], there[path])
    return sorted(found.items())


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
