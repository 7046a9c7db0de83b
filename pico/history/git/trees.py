"""The manifests in a tree of Git: which count, and what is passed over."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Iterator
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.file_names import hidden, is_manifest, named_as_manifest, set_aside_from
from pico.manifest.files import MAX_LEVELS

Odd = tuple[str, Any]
"""A path in a tree, and what stands there."""

MAX_ENTRIES = 300_000
"""Files and folders of a revision. A tree of a few kilobytes can hold ten thousand million of them."""


Module = Callable[[str, Any], Any]
"""Returns the tree of the submodule at a path of which a tree holds an entry; None where its content is not here."""


def manifests(
    tree: Any,
    odd: list[Odd] | None = None,
    module: Module = lambda path, entry: None,
    aside: list[Odd] | None = None,
) -> Iterator[Odd]:
    """Yield the manifests of a tree, by path; add to `odd` what may hide one: links, submodules, other spellings, and
    to `aside` what is called as one that is set aside, also in folders with a dot.

    What `module` returns of a submodule is read as a folder is.
    """
    from pygit2.enums import FileMode

    def enters(folder: str) -> bool:
        return not hidden(folder) if aside is None else posixpath.basename(folder) not in ("runs", ".pico")

    for path, entry in entries(tree, enters, module):
        elsewhere = entry.filemode in (FileMode.COMMIT, FileMode.LINK)
        if is_manifest(path) and not elsewhere:
            yield path, entry
        elif odd is not None and (elsewhere or named_as_manifest(path)) and not hidden(path):
            odd.append((path, entry))
        elif aside is not None and not elsewhere and set_aside_from(path):
            aside.append((path, entry))


def entries(
    tree: Any, enter: Callable[[str], bool] = lambda folder: True, module: Module = lambda path, entry: None
) -> Iterator[Odd]:
    """Yield what is no folder in a tree and in those of its folders that `enter` (a path) allows, by path.

    Raises PicoError for a tree that is too deep or too large to be a lab's.
    """
    seen, below = 0, [("", iter(tree))]
    while below:
        at, listed = below[-1]
        entry = next(listed, None)
        if entry is None:
            below.pop()
            continue
        seen += 1
        path = f"{at}{entry.name}"
        if len(below) > MAX_LEVELS or seen > MAX_ENTRIES:
            raise PicoError(_too_much(at, deep=len(below) > MAX_LEVELS))
        folder = entry if entry.type_str == "tree" else module(path, entry) if entry.type_str == "commit" else None
        if folder is None:
            yield path, entry
        elif enter(path):
            below.append((f"{path}/", iter(folder)))


def _too_much(at: str, *, deep: bool) -> Diagnostic:
    hint = "no lab is like that: look at it with `git ls-tree` before you trust it"
    if deep:
        return error("too-deep", f"folders nested deeper than {MAX_LEVELS}, below {at[:60]}", hint=hint)
    return error("too-many", f"a revision holds more than {MAX_ENTRIES} files and folders", hint=hint)


def subtree(tree: Any, folder: str) -> Any:
    """Return the tree of a folder (empty: the tree itself) in a tree, None where that has no such folder."""
    try:
        found = tree[folder] if folder else tree
    except KeyError:
        return None
    return found if found.type_str == "tree" else None


def folder_id(commit: Any, folder: str) -> str | None:
    """Return the id of what `folder` holds in a commit, None where the commit does not have it."""
    try:
        return str(commit.tree[folder].id)
    except KeyError:
        return None
