"""From what a user writes (`e1`, `C3`, `HEAD~2`, `4f2c9a1`) to a commit, and from a commit to its names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Any

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.history.git import command as git
from pico.history.git.shallow import cut_off

TAGS, BRANCHES, REMOTES = "refs/tags/", "refs/heads/", "refs/remotes/"
_FETCH = 0
"""The direction of a refspec (`GIT_DIRECTION_FETCH` of libgit2)."""
_FULL_ID = re.compile(r"[0-9a-f]{40}")
_OPERATOR = re.compile(r"[~^:]|@\{")
"""What ends the name of a ref in a revision: `e1~2`, `e1^{commit}`, `e1@{1}`."""
_RULES = (
    ("", ""), ("refs/", ""), (TAGS, ""), (BRANCHES, ""), (REMOTES, ""), (REMOTES, "/HEAD"),
)  # fmt: skip
"""What a name may be short for, in Git's order (gitrevisions)."""


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

    What only git understands is asked of git; a branch that only remotes have counts, as in `git checkout`.
    Raises PicoError naming the revision, with the nearest name, and for a name with several meanings.
    """
    import pygit2

    require_name(revision)
    name = "@{-1}" if revision == "-" else revision
    if not _FULL_ID.fullmatch(name):
        _refuse_ambiguous(handle, name)
    try:
        return handle.revparse_single(name).peel(pygit2.Commit)
    except (KeyError, ValueError, pygit2.GitError):
        pass
    remote = _tracked(handle, name)
    if remote is not None:
        return handle.references[remote].peel(pygit2.Commit)
    try:
        asked = ["rev-parse", "--verify", "--quiet", "--end-of-options", name + "^{commit}"]
        return handle[git.run(root, asked, doing=f"find {revision}").strip()]
    except (PicoError, KeyError, ValueError):
        raise PicoError(_unknown(handle, revision)) from None


def require_name(revision: str) -> None:
    """Raise PicoError for a revision without a name, as an empty variable of a shell leaves one."""
    if not revision.strip():
        hint = "name a branch, a tag or a commit; leave the word out to mean the manifest or HEAD"
        raise PicoError(error("revision", "an empty word names no revision", hint=hint))


def spelled(handle: Any, revision: str) -> str:
    """Return `origin/e1` for `e1` where only a remote has such a branch, else the revision as it is."""
    import pygit2

    try:
        handle.revparse_single("@{-1}" if revision == "-" else revision)
    except (KeyError, ValueError, pygit2.GitError):
        with suppress(PicoError):
            return (_tracked(handle, revision) or revision).removeprefix(REMOTES)
    return revision


def branch_for(handle: Any, root: Path, revision: str) -> str:
    """Return the ref of the branch that a checkout of `revision` is on, empty for none; one that a remote alone has is
    made. Raises PicoError where another worktree has it checked out."""
    name = git.answer(root, ["rev-parse", "--abbrev-ref", "@{-1}"]).strip() if revision == "-" else revision
    names = (name, name.removeprefix(BRANCHES), name.removeprefix("heads/"))
    ref = next((f"{BRANCHES}{n}" for n in names if f"{BRANCHES}{n}" in handle.references), "")
    if not ref:
        return _made_from_remote(handle, root, name)
    listed = git.run(root, ["worktree", "list", "--porcelain"], doing="list the worktrees").split("\n\n")
    for worktree in listed:
        lines = worktree.splitlines()
        if f"branch {ref}" in lines and Path(lines[0].removeprefix("worktree ")).resolve() != root:
            text = f"{name} is checked out in {lines[0].removeprefix('worktree ')}"
            hint = f"work there, or make a branch of your own: `git switch -c NAME {name}`"
            raise PicoError(error("worktree", text, hint=hint))
    return ref


def _made_from_remote(handle: Any, root: Path, name: str) -> str:
    """Return the ref of the branch `name`, made to track that of a remote; empty if no remote has one, or if the name
    means something else."""
    try:
        handle.revparse_single(name)
        return ""
    except (KeyError, ValueError):
        tracked = _tracked(handle, name, to_track=True)
    if tracked is None:
        return ""
    git.run(root, ["branch", "--quiet", "--track", "--", name, tracked], doing=f"make the branch {name}")
    return f"{BRANCHES}{name}"


def _refuse_ambiguous(handle: Any, revision: str) -> None:
    """Raise PicoError if the ref that a revision begins with is one of several, at different commits.

    Git reads such a name as the tag (`git rev-parse`), but checks out the branch.
    """
    import pygit2

    name = _OPERATOR.split(revision, maxsplit=1)[0]
    if name in ("", "HEAD", "@"):
        return
    meant: dict[str, str] = {}
    for prefix, suffix in _RULES:
        ref = f"{prefix}{name}{suffix}"
        with suppress(KeyError, ValueError, pygit2.GitError):
            meant[ref] = str(handle.references[ref].peel(pygit2.Commit).id)
    if len(set(meant.values())) < 2:
        return
    refs = [(ref, f"{_shown(ref)} ({_kind(ref)}, {commit[:7]})") for ref, commit in meant.items()]
    rest = revision[len(name) :]
    forms = " or ".join(f"`{_shown(ref)}{rest}`" for ref, _ in refs)
    text = f"`{name}` is ambiguous: {' and '.join(words for _, words in refs)}"
    raise PicoError(error("ambiguous", text, hint=f"name one of them: {forms}"))


def _shown(ref: str) -> str:
    """Return the shortest name of a ref that is not a name of another kind of ref: `heads/e1`, `tags/e1`."""
    return ref.removeprefix("refs/")


def _kind(ref: str) -> str:
    kinds = {TAGS: "tag", BRANCHES: "branch", REMOTES: "branch of a remote"}
    return next((kind for prefix, kind in kinds.items() if ref.startswith(prefix)), "ref")


def _tracked(handle: Any, name: str, *, to_track: bool = False) -> str | None:
    """Return the remote-tracking ref that `git checkout` takes for a branch that is not here; None if no remote has it.

    That of `checkout.defaultRemote`, or the only one; also one of several at the same commit, unless a branch is
    `to_track` it. Raises PicoError if there are several.
    """
    import pygit2

    found: dict[str, str] = {}
    for remote in handle.remotes:
        for number in range(remote.refspec_count):
            with suppress(KeyError, ValueError, pygit2.GitError):
                spec = remote.get_refspec(number)
                if spec.direction == _FETCH and spec.src_matches(f"{BRANCHES}{name}"):
                    ref = spec.transform(f"{BRANCHES}{name}")
                    handle.references[ref].peel(pygit2.Commit)
                    found[str(remote.name)] = ref
    with suppress(KeyError):
        found = {r: ref for r, ref in found.items() if r == handle.config["checkout.defaultRemote"]} or found
    refs = sorted(set(found.values()))
    commits = {str(handle.references[ref].peel(pygit2.Commit).id) for ref in refs}
    if len(refs) > 1 and (to_track or len(commits) > 1):
        names = [ref.removeprefix(REMOTES) for ref in refs]
        hint = " or ".join(f"`{n}`" for n in names)
        default = sorted(found)[0]
        hint = f"name one of them: {hint}; `git config checkout.defaultRemote {default}` makes {default} the default"
        raise PicoError(error("ambiguous", f"`{name}` is ambiguous: a branch at {' and '.join(names)}", hint=hint))
    return refs[0] if refs else None


def _unknown(handle: Any, revision: str) -> Diagnostic:
    if handle.head_is_unborn:
        hint = 'nothing is committed yet: `pico apply`, then `pico commit -m "first state"`'
        return error("revision", f"there is no revision `{revision}`", hint=hint)
    alike = _beginning_with(handle, revision)
    if len(alike) > 1:
        hint = "write more of it: " + ", ".join(f"`{c[:12]}`" for c in alike[:4])
        return error("revision", f"several commits begin with `{revision}`", hint=hint)
    if handle.is_shallow:
        return cut_off(handle, f"the commits that it has do not include `{revision}`")
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
