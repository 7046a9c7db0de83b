"""The manifests in a tree of Git: which count, and what is passed over."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import PurePosixPath
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, error
from pico.manifest.files import MAX_BYTES, MAX_LEVELS

MAX_ENTRIES = 300_000
"""Files and folders of a revision. A tree of a few kilobytes can hold ten thousand million of them."""


def collect(tree: Any, at: PurePosixPath, found: dict[str, bytes], skipped: list[str]) -> None:
    """Add the manifests of `tree`, which lies at `at`, to `found`; links and submodules to `skipped`."""
    from pygit2.enums import FileMode

    for path, entry in entries(tree, lambda folder: not left_out(f"{folder}/*")):
        if entry.filemode == FileMode.COMMIT or (entry.filemode == FileMode.LINK and is_manifest(path)):
            skipped.append(str(at / path))
        elif is_manifest(path):
            found[str(at / path)] = bytes(memoryview(entry)[: MAX_BYTES + 1])  # more makes the reader refuse it


def entries(tree: Any, enter: Callable[[str], bool] = lambda folder: True) -> Iterator[tuple[str, Any]]:
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
        if entry.type_str == "tree":
            below += [(f"{path}/", iter(entry))] if enter(path) else []
        else:
            yield path, entry


def _too_much(at: str, *, deep: bool) -> Diagnostic:
    hint = "no lab is like that: look at it with `git ls-tree` before you trust it"
    if deep:
        return error("too-deep", f"folders nested deeper than {MAX_LEVELS}, below {at[:60]}", hint=hint)
    return error("too-many", f"a revision holds more than {MAX_ENTRIES} files and folders", hint=hint)


def is_manifest(path: str) -> bool:
    """Return whether a file of this path may be a manifest: `*.yaml`, not hidden, not in a folder that is left out."""
    return path.endswith(".yaml") and not PurePosixPath(path).name.startswith(".") and not left_out(path)


def left_out(path: str) -> bool:
    """Return whether a path lies in a dot-folder or in a folder called `runs`."""
    return any(part.startswith(".") or part == "runs" for part in PurePosixPath(path).parts[:-1])


def folder_id(commit: Any, folder: str) -> str | None:
    """Return the id of what `folder` holds in a commit, None where the commit does not have it."""
    try:
        return str(commit.tree[folder].id)
    except KeyError:
        return None
