"""The manifests in a tree of Git: which count, and what is passed over."""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import Any


def collect(tree: Any, at: PurePosixPath, found: dict[str, bytes], skipped: list[str]) -> None:
    """Add the manifests of `tree`, which lies at `at`, to `found`; links and submodules to `skipped`."""
    from pygit2.enums import FileMode

    for entry in tree:
        path = at / entry.name
        if entry.filemode == FileMode.TREE:
            if not left_out(str(path / "*")):
                collect(entry, path, found, skipped)
        elif entry.filemode == FileMode.COMMIT or (entry.filemode == FileMode.LINK and is_manifest(str(path))):
            skipped.append(str(path))
        elif is_manifest(str(path)):
            found[str(path)] = entry.data


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
