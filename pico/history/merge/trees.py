"""Three trees of manifests merged in memory: what both sides changed is merged by value, whichever file it is in."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any

from pico.history.git.partial import open_handle
from pico.history.git.trees import entries, subtree
from pico.history.merge.alignment import Alike, Files, Versions, made_alike, settled
from pico.history.merge.groups import groups_of, is_lab
from pico.history.merge.leaves import Conflict, Coupled
from pico.history.merge.manifests import Merged, merge
from pico.history.merge.markers import Labels
from pico.history.merge.renames import called_alike
from pico.manifest.file_names import is_manifest


@dataclass
class Union:
    """What came of a merge in memory: the tree's id, and by path what stands in the way."""

    tree: str = ""
    conflicts: list[tuple[str, Conflict]] = field(default_factory=list)
    coupled: list[tuple[str, Coupled]] = field(default_factory=list)
    files: list[str] = field(default_factory=list)


def opened(root: Path) -> Any:
    """Return the repository at `root` as libgit2 holds it."""
    return open_handle(root)


def unite_commits(handle: Any, ours: str, theirs: str, labels: Labels) -> Union:
    """Merge two commits over what both come from: libgit2 unites the trees, PICO the manifests that both changed."""
    index = handle.merge_commits(ours, theirs)
    trees = [handle[str(handle.merge_base(ours, theirs))].tree, handle[ours].tree, handle[theirs].tree]
    return _united(handle, index, trees, labels)


def unite_trees(handle: Any, base: str, ours: str, theirs: str, labels: Labels) -> Union:
    """Do to the tree `ours` what leads from the tree `base` to `theirs`, value by value."""
    index = handle.merge_trees(*(handle[name] for name in (base, ours, theirs)))
    return _united(handle, index, [handle[name] for name in (base, ours, theirs)], labels)


def manifest_tree(handle: Any, tree: Any, folder: str, more: Any = None) -> str:
    """Write a tree with the manifests of `tree`, and of `more` (None: of nothing), below `folder`, at their paths;
    return its id."""
    import pygit2

    index = pygit2.Index()
    tops = [subtree(each, folder) for each in (tree, more) if each is not None]
    for path, entry in (e for top in tops if top is not None for e in _entries(top, f"{folder}/" if folder else "")):
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
    for path, entry in entries(handle[into]):
        index.add(pygit2.IndexEntry(path, entry.id, entry.filemode))
    return str(index.write_tree(handle))


def contents(handle: Any, tree: Any) -> dict[str, bytes]:
    """Return the manifests of a tree by path."""
    return {path: handle[blob].data for path, blob in blobs(tree).items() if is_manifest(path)}


def blobs(tree: Any) -> dict[str, Any]:
    """Return the ids of the files of a tree by path."""
    return {path: entry.id for path, entry in _entries(tree)}


def alike(handle: Any, trees: Sequence[Any]) -> Alike:
    """Return the manifests that differ between three trees (base, ours, theirs), made alike; see `made_alike`."""
    ids = [{path: blob for path, blob in blobs(tree).items() if is_manifest(path)} for tree in trees]
    paths = [path for path in set().union(*ids) if len({known.get(path) for known in ids}) > 1]
    labs = {str(PurePosixPath(p).parent) for known in ids for p, blob in known.items() if is_lab(handle[blob].data)}
    base, ours, theirs = ({path: handle[known[path]].data for path in paths if path in known} for known in ids)
    return made_alike(*called_alike(base, ours, theirs, labs), labs)


def _entries(tree: Any, at: str = "") -> list[tuple[str, Any]]:
    from pygit2.enums import FileMode

    return [(at + p, e) for p, e in entries(tree) if e.type_str == "blob" and e.filemode != FileMode.LINK]


def _united(handle: Any, index: Any, trees: Sequence[Any], labels: Labels) -> Union:
    """Unite the manifests that differ, and what libgit2 could not, into `index`, where it has united all else."""
    made = alike(handle, trees)
    union = Union(conflicts=list(made.conflicts))
    groups, strict = groups_of(contents(handle, trees[1]).items())
    united: Files = {}
    for path, (was, mine, other) in sorted({**_left(handle, index, made.paths), **made.versions()}.items()):
        data = other if mine == was else mine
        if mine not in (was, other) and other != was:
            if mine is None or other is None:
                union.files.append(path)
                continue
            merged = merge(was, mine, other, labels=labels, groups=groups, strict=strict)
            _note(union, path, merged)
            data = merged.data
        if data is not None:
            united[path] = data
    if not union.conflicts and not union.files:
        united, union.files = settled(made, united)
    if not union.conflicts and not union.files:
        _put(handle, index, made.paths, united, trees)
        union.tree = str(index.write_tree(handle))
    return union


def _left(handle: Any, index: Any, paths: Collection[str]) -> dict[str, Versions]:
    """Return the files but `paths` that libgit2 could not unite, in base, ours and theirs."""
    found: dict[str, Versions] = {}
    for sides in list(index.conflicts or ()):
        path = next(e.path for e in (sides[1], sides[2], sides[0]) if e)
        if path not in paths:
            was, mine, other = (handle[e.id].data if e else None for e in sides)
            found[path] = (was, mine, other)
    return found


def _put(handle: Any, index: Any, paths: Collection[str], united: Files, trees: Sequence[Any]) -> None:
    """Give an index what files hold now; those of `paths` that are not among them are gone."""
    import pygit2

    for path in {*paths, *united}:
        if index.conflicts is not None and path in index.conflicts:
            del index.conflicts[path]
        if path in index:
            index.remove(path)
    for path, data in united.items():
        mode = next((tree[path].filemode for tree in trees[1:] if path in tree), pygit2.enums.FileMode.BLOB)
        index.add(pygit2.IndexEntry(path, handle.create_blob(data), mode))


def _note(union: Union, path: str, merged: Merged) -> None:
    union.conflicts += [(path, c) for c in merged.conflicts]
    union.coupled += [(path, c) for c in merged.coupled]
    if not merged.clean and not merged.conflicts:
        union.files.append(path)
