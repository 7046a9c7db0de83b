"""Edits that somebody makes without a checkout, on a page say: a commit on a branch of their own, `web/NAME`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pico.diagnostics import Diagnostic, ExitCode, PicoError, error
from pico.manifest.text.source import Source
from pico.manifest.text.tree import parse
from pico.server.git.hosting import git

_PATH = re.compile(r"(?!.*\.\.)[A-Za-z0-9_-][A-Za-z0-9._-]{0,99}(?:/[A-Za-z0-9_-][A-Za-z0-9._-]{0,99}){0,9}\.yaml")
_NONE = "0" * 40


def committed(path: Path, who: str, base: str, files: Mapping[str, str | None], message: str) -> dict[str, str]:
    """Commit files (None: without it) on top of `base` in the bare repository at `path`, as `who`, and return `commit`,
    `branch` and `parent`. Only manifests can be edited so, and what is no YAML is refused; where the branch holds what
    `base` does not, PicoError (exit code STALE)."""
    import pygit2
    from pygit2.enums import FileMode

    repository = pygit2.Repository(str(path))
    parent = _revision(repository, base)
    branch = f"web/{who}"
    tip = repository.references.get(f"refs/heads/{branch}")
    before = tip.target if tip is not None else None
    if before is not None and before != parent.id and not repository.descendant_of(parent.id, before):
        hint = f"begin with {branch} ({str(before)[:9]}), or merge it first"
        raise PicoError(error("stale", f"{branch} holds more than {base}", hint=hint), ExitCode.STALE)
    _require_manifests(files)
    index = pygit2.Index()
    index.read_tree(parent.tree)
    for name, text in files.items():
        _require_place(index, name)
        if text is not None:
            index.add(pygit2.IndexEntry(name, repository.create_blob(text.encode()), FileMode.BLOB))
        elif name in index:
            index.remove(name)
    signature = pygit2.Signature(who, f"{who}@pico.invalid")
    tree = index.write_tree(repository)
    commit = repository.create_commit(None, signature, signature, message, tree, [parent.id])
    if before is not None and (desk := _checked_out(path, branch)):
        try:
            git("-C", desk, "read-tree", "-m", "-u", str(before), str(commit))
        except PicoError as exc:
            hint = "commit there first, or edit there"
            text = f"the desk of {branch} has edits of its own in these files"
            raise PicoError(error("stale", text, hint=hint), ExitCode.STALE) from exc
    git("--git-dir", str(path), "update-ref", f"refs/heads/{branch}", str(commit), str(before or _NONE))
    return {"commit": str(commit), "branch": branch, "parent": str(parent.id)}


def _checked_out(path: Path, branch: str) -> str | None:
    """Return the worktree that a branch is checked out in."""
    for one in git("--git-dir", str(path), "worktree", "list", "--porcelain").split("\n\n"):
        lines = one.splitlines()
        if f"branch refs/heads/{branch}" in lines:
            return lines[0].removeprefix("worktree ")
    return None


def _revision(repository: Any, base: str) -> Any:
    import pygit2

    try:
        return repository.revparse_single(f"{base}^{{commit}}")
    except (KeyError, ValueError, pygit2.GitError) as exc:
        raise PicoError(error("revision", f"there is no commit {base[:80]!r} here", hint="push it first")) from exc


def _require_manifests(files: Mapping[str, str | None]) -> None:
    found: list[Diagnostic] = []
    for name, text in files.items():
        if not _PATH.fullmatch(name):
            found.append(error("path", f"{name[:200]!r} is no manifest of a lab", hint="such as `state/table.yaml`"))
        elif text is not None:
            found += parse(Source(name, text))[1]
    if found:
        raise PicoError(found)


def _require_place(index: Any, name: str) -> None:
    """Raise PicoError where something else than a file stands at a path, or a file where a folder would be."""
    from pygit2.enums import FileMode

    parents = {str(parent) for parent in Path(name).parents}
    for entry in index:
        other = entry.path == name and entry.mode not in (FileMode.BLOB, FileMode.BLOB_EXECUTABLE)
        if other or entry.path in parents or entry.path.startswith(f"{name}/"):
            raise PicoError(error("path", f"{entry.path} is in the way of {name}"))
