"""What the tree of a commit holds of a lab and PICO does not read: links, submodules, manifests by other names."""

from __future__ import annotations

import contextlib
import posixpath
from collections.abc import Collection, Iterable
from pathlib import Path, PurePosixPath
from typing import Any, Protocol

from pico.diagnostics import Diagnostic, PicoError
from pico.history.git.trees import Module, Odd, entries, manifests, subtree
from pico.manifest.file_names import (
    MAX_BYTES,
    about,
    declares_api,
    hidden,
    is_manifest,
    left_out,
    linked,
    misnamed_manifest,
    named_as_manifest,
    set_aside,
    set_aside_from,
    unseen,
)
from pico.manifest.links import broken_link, manifest_behind


class Roots(Protocol):
    """The top of a working tree, and git's folder that all worktrees share."""

    @property
    def root(self) -> Path: ...

    @property
    def common(self) -> Path: ...


def read_tree(
    repository: Roots, top: Any, lab: str, name: str, diagnostics: list[Diagnostic] | None = None
) -> dict[str, bytes]:
    """Return the manifests of the folder `lab` in the whole tree `top` of a commit, by path in that folder.

    What may hide one is told in `diagnostics`; without these, errors among it are raised. `name`: what diagnostics
    call the commit. Raises PicoError.
    """
    odd: list[Odd] = []
    aside: list[Odd] = []
    files: dict[str, bytes] = {}
    unread: list[Diagnostic] = []
    for path, entry in manifests(subtree(top, lab) or (), odd, modules(repository, lab), aside):
        data = content_of(entry)
        if data is None:
            hint = "`git fsck` says what is missing; `git fetch` may bring it back"
            unread.append(about(f"{name}:{path}", "git-unreadable", "what git keeps of it is missing or damaged", hint))
        else:
            files[path] = data
    unread += unread_at(repository, top, lab, odd, name)
    for path, entry in no_copies(aside, files):
        unread += set_aside(f"{name}:{path}", content_of(entry) or b"")
    if diagnostics is not None:
        diagnostics += unread
    elif any(d.severity == "error" for d in unread):
        raise PicoError(unread)
    return files


def no_copies(aside: Iterable[Odd], files: Collection[str]) -> list[Odd]:
    """Return what is set aside, without copies of the manifests `files` that are read, and without other labs."""
    found = list(aside)
    labs = {posixpath.dirname(path) for path, _ in found if posixpath.basename(path) == "lab.yaml"}
    names = {posixpath.basename(path) for path in files}
    return [
        (path, entry)
        for path, entry in found
        if not (labs and labs.intersection(map(str, PurePosixPath(path).parents)))
        and posixpath.join(posixpath.dirname(path), set_aside_from(path)) not in files
        and not (left_out(path) and set_aside_from(path) in names)
    ]


def content_of(entry: Any) -> bytes | None:
    """Return what a file holds, of one that is too large as much as makes the reader say so; None where it is lost."""
    import pygit2

    try:
        return bytes(memoryview(entry)[: MAX_BYTES + 1])
    except (KeyError, pygit2.GitError):
        return None


def unread_at(repository: Roots, top: Any, lab: str, odd: Iterable[Odd], name: str) -> list[Diagnostic]:
    """Return what to say of the `odd` entries of the folder `lab` of a commit, whose whole tree is `top`.

    `name`: what diagnostics call the commit.
    """
    tree = _Tree(repository, top, lab)
    found = (tree.said(path, entry, f"{name}:{path}") for path, entry in odd)
    return [d for d in found if d]


class _Tree:
    """The tree of a commit, in which a lab is one of the folders."""

    def __init__(self, repository: Roots, top: Any, lab: str) -> None:
        self.repository, self.top, self.lab = repository, top, lab

    def said(self, path: str, entry: Any, shown: str) -> Diagnostic | None:
        from pygit2.enums import FileMode

        if entry.filemode == FileMode.COMMIT:
            return submodule(self.repository, posixpath.join(self.lab, path), str(entry.id), shown)
        if entry.filemode == FileMode.LINK:
            return self._link(path, bytes(entry.data).decode(errors="replace"), shown)
        return misnamed_manifest(shown) if declares_api(bytes(entry.data)) else None

    def _link(self, path: str, target: str, shown: str) -> Diagnostic | None:
        """Return what to say of a link: a tree is searched where it leads into one, the disk where it leads out."""
        if is_manifest(path):
            return about(shown, "symlink", "a symbolic link is not read", "put the file itself there")
        at = posixpath.normpath(posixpath.join(self.lab, posixpath.dirname(path), target))
        if at.startswith(("/", "../")) or at == "..":
            root = self.repository.root
            return manifest_behind(root / self.lab / posixpath.dirname(path) / target, root / self.lab, shown, target)
        if self._is_read(at):
            return None
        goal = self._entry(at)
        if goal is None:
            return broken_link(shown, target)
        if goal.type_str == "tree":
            holds = next((p for p, e in _ours(goal) if not self._is_read(posixpath.join(at, p))), "")
            return linked(shown, target, holds) if holds else None
        return linked(shown, target, at) if named_as_manifest(path) and declares_api(bytes(goal.data)) else None

    def _is_read(self, at: str) -> bool:
        """Return whether what lies at a path of the commit is read as one of the lab's."""
        inside = at if not self.lab else posixpath.relpath(at, self.lab)
        if inside == ".":
            return True
        if inside.startswith("../") or inside == ".." or hidden(inside):
            return False
        entry = self._entry(at)
        return entry is not None and (entry.type_str == "tree" or is_manifest(inside))

    def _entry(self, at: str) -> Any:
        """Return what stands at a path of the commit, or in a submodule of it that is here; None for nothing."""
        found, done, module = self.top, "", modules(self.repository)
        for part in at.split("/") if at != "." else ():
            done = posixpath.join(done, part)
            if found.type_str != "tree" or part not in found:
                return None
            found = module(done, found[part]) or found[part]
        return found


def _ours(tree: Any) -> Iterable[Odd]:
    """Yield the manifests in a tree, under whatever name."""
    listed = entries(tree, lambda folder: not hidden(folder))
    return (
        (p, e)
        for p, e in listed
        if e.type_str == "blob" and named_as_manifest(p) and not hidden(p) and declares_api(e.data)
    )


def submodule(repository: Roots, path: str, commit: str, shown: str) -> Diagnostic | None:
    """Return what to say of the submodule at `path` (from the top) whose content at a commit is not among the files."""
    fetch = (
        f"git -C {path} fetch" if (repository.root / path / ".git").exists() else f"git submodule update --init {path}"
    )
    hint = f"`{fetch}`, or `git rm {path}` if it is not wanted"
    tree = _tree_of(repository, path, commit)
    if tree is None:
        return unseen(shown, "a submodule whose content is not here", hint)
    holds = next((p for p, _ in _ours(tree)), "")
    text = f"a submodule, and the manifest {holds} in it is not read"
    return about(shown, "submodule", text, hint) if holds else None


def modules(repository: Roots, lab: str = "") -> Module:
    """Return what finds the content of submodules below the folder `lab` that this clone has."""
    return lambda path, entry: (
        _tree_of(repository, posixpath.join(lab, path), str(entry.id)) if entry.type_str == "commit" else None
    )


def _tree_of(repository: Roots, path: str, commit: str) -> Any:
    """Return the tree of a commit of a submodule, None where this clone has none."""
    import pygit2

    for place, sign in ((repository.root / path, ".git"), (repository.common / "modules" / path, "HEAD")):
        if (place / sign).exists():
            with contextlib.suppress(KeyError, ValueError, AttributeError, pygit2.GitError):
                return pygit2.Repository(str(place))[commit].tree
    return None
