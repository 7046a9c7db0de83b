"""From what a user writes (`e1`, `C3`, `HEAD~2`, `4f2c9a1`) to a commit, and from a commit to its names."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.history.git import command as git

TAGS, BRANCHES, REMOTES = "refs/tags/", "refs/heads/", "refs/remotes/"


def names_at(handle: Any, *kinds: str) -> dict[str, tuple[str, ...]]:
    """Return the short names at each commit id: of `kinds` in their order (tags, branches, remotes), then by name."""
    import pygit2

    prefixes = kinds or (TAGS, BRANCHES, REMOTES)
    at: dict[str, list[tuple[int, str]]] = {}
    for name in handle.references:
        kind = next((i for i, prefix in enumerate(prefixes) if name.startswith(prefix)), None)
        if kind is None or (name.startswith(REMOTES) and name.endswith("/HEAD")):
            continue
        try:
            commit = handle.references[name].peel(pygit2.Commit)
        except (KeyError, ValueError, pygit2.GitError):  # a tag of a file, or a ref to nothing
            continue
        at.setdefault(str(commit.id), []).append((kind, name.removeprefix(prefixes[kind])))
    return {commit: tuple(name for _, name in sorted(names)) for commit, names in at.items()}


def find(handle: Any, root: Path, revision: str) -> Any:
    """Return the commit that `revision` names, as libgit2 holds it; `root` is the top of the working tree.

    What only git understands is asked of git; a branch that one remote alone has counts, as in `git checkout`.
    Raises PicoError naming the revision, with the nearest name.
    """
    import pygit2

    name = "@{-1}" if revision == "-" else revision
    try:
        return handle.revparse_single(name).peel(pygit2.Commit)
    except (KeyError, ValueError, pygit2.GitError):
        pass
    remote = _on_one_remote(handle, name)
    if remote is not None:
        return handle[remote]
    try:
        asked = ["rev-parse", "--verify", "--quiet", "--end-of-options", name + "^{commit}"]
        return handle[git.run(root, asked, doing=f"find {revision}").strip()]
    except (PicoError, KeyError, ValueError):
        raise PicoError(_unknown(handle, revision)) from None


def branch_for(handle: Any, root: Path, revision: str) -> str:
    """Return the ref of the branch that a checkout of `revision` is on, empty for none; one that a remote alone has is
    made. Raises PicoError where another worktree has it checked out."""
    name = git.answer(root, ["rev-parse", "--abbrev-ref", "@{-1}"]).strip() if revision == "-" else revision
    ref = f"{BRANCHES}{name}"
    if ref not in handle.references:
        remote = [
            r for r in handle.references if r.startswith(REMOTES) and r.removeprefix(REMOTES).endswith(f"/{name}")
        ]
        try:
            handle.revparse_single(name)
        except (KeyError, ValueError):
            if len(remote) == 1:
                git.run(root, ["branch", "--quiet", "--", name, remote[0]], doing=f"make the branch {name}")
                return ref
        return ""
    listed = git.run(root, ["worktree", "list", "--porcelain"], doing="list the worktrees").split("\n\n")
    for worktree in listed:
        lines = worktree.splitlines()
        if f"branch {ref}" in lines and Path(lines[0].removeprefix("worktree ")).resolve() != root:
            text = f"{name} is checked out in {lines[0].removeprefix('worktree ')}"
            hint = f"work there, or make a branch of your own: `git switch -c NAME {name}`"
            raise PicoError(error("worktree", text, hint=hint))
    return ref


def _on_one_remote(handle: Any, name: str) -> str | None:
    found = [
        commit for commit, refs in names_at(handle, REMOTES).items() for ref in refs if ref.partition("/")[2] == name
    ]
    return found[0] if len(found) == 1 else None


def _unknown(handle: Any, revision: str) -> Diagnostic:
    if handle.head_is_unborn:
        hint = 'nothing is committed yet: `pico apply`, then `pico commit -m "first state"`'
        return error("revision", f"there is no revision `{revision}`", hint=hint)
    alike = _beginning_with(handle, revision)
    if len(alike) > 1:
        hint = "write more of it: " + ", ".join(f"`{c[:12]}`" for c in alike[:4])
        return error("revision", f"several commits begin with `{revision}`", hint=hint)
    if handle.is_shallow:
        hint = "this clone holds only the last commits; `git fetch --unshallow --tags` brings the others"
        return error("revision", f"there is no revision `{revision}`", hint=hint)
    names = {name for refs in names_at(handle).values() for name in refs}
    folded = {name.lower(): name for name in names}
    recent = {commit[:7] for commit in islice(_history(handle), 200)}
    hint = f"did you mean `{folded[revision.lower()]}`?" if revision.lower() in folded else ""
    hint = hint or did_you_mean(revision, names | recent if len(revision) == 7 else names)
    return error("revision", f"there is no revision `{revision}`", hint=hint or "`pico log --graph` shows them")


def _beginning_with(handle: Any, revision: str) -> list[str]:
    start = revision.lower()
    if not 4 <= len(start) <= 40 or not set(start) <= set("0123456789abcdef"):
        return []
    return [commit for commit in _history(handle) if commit.startswith(start)]


def _history(handle: Any) -> Iterator[str]:
    from pygit2.enums import SortMode

    return (str(commit.id) for commit in handle.walk(handle.head.target, SortMode.TIME))
