"""Edits shelved in git's stash, as objects first: the stash has them before any file is taken back."""

from __future__ import annotations

from collections.abc import Sequence

from pico.diagnostics import PicoError
from pico.history.git import command as git
from pico.history.writing.claim import Claim, GitFolders, Goal
from pico.history.writing.locked_git import LockedGit, listed


def shelf(at: GitFolders, claim: Claim, base: str, paths: Sequence[str], message: str) -> tuple[str, str]:
    """Write the commit of a shelf that holds files as they are, as `git stash` would, and return it.

    With it, the tree of `base` with all of these files. New ones are in a commit of their own, so that a pop brings
    them back as new. Raises PicoError in git's words.
    """
    here, work = LockedGit(at, claim), LockedGit(at, claim, "index.files")
    here.begin()
    staged = here.git("write-tree", doing="shelve what is staged").strip()
    known = set(here.git("ls-files", "-z", doing="list the files").split("\0")) | _named(work, base)
    new = [p for p in paths if p not in known]
    work.git("read-tree", base, doing="shelve the edits")
    subject = git.run(at.root, ["log", "-1", "--format=%h %s", base], doing="read a commit").strip()
    branch = git.answer(at.root, ["symbolic-ref", "--short", "--quiet", "HEAD"]).strip() or "(no branch)"
    parents = [base, _commit(work, staged, [base], f"index on {branch}: {subject}")]
    tree = _added(work, [p for p in paths if p in known])
    if new:
        alone = LockedGit(at, claim, "index.new")
        alone.git("read-tree", "--empty", doing="shelve new files")
        parents.append(_commit(work, _added(alone, new), [], f"untracked files on {branch}: {subject}"))
    said = f"On {branch}: {message}" if message else f"WIP on {branch}: {subject}"
    return _commit(work, tree, parents, said), _added(work, new)


def _named(under: LockedGit, tree: str) -> set[str]:
    return set(under.git("ls-tree", "-r", "-z", "--name-only", tree, doing="list the files").split("\0"))


def _added(under: LockedGit, paths: Sequence[str]) -> str:
    if paths:
        under.git("add", "--all", "--force", *listed(under.at, paths), doing="shelve the edits")
    return under.git("write-tree", doing="shelve the edits").strip()


def _commit(under: LockedGit, tree: str, parents: Sequence[str], message: str) -> str:
    above = [word for parent in parents for word in ("-p", parent)]
    return under.git("commit-tree", *above, tree, doing="shelve the edits", stdin=message).strip()


def stored(under: LockedGit, to: Goal) -> PicoError | None:
    """Let the stash have a shelf, if it has not; return why it can't."""
    subject = git.run(under.at.root, ["log", "-1", "--format=%s", to.shelf], doing="read a shelf").strip()
    words = ("stash", "store", "--quiet", "-m", subject, to.shelf)
    return None if to.shelf in _shelves(under) else _tried(under, words, "shelve the edits")


def dropped(under: LockedGit, to: Goal) -> PicoError | None:
    """Take a shelf out of the stash, if it has it; return why it can't be."""
    known = _shelves(under)
    if to.shelf not in known:
        return None
    return _tried(under, ("stash", "drop", "--quiet", f"stash@{{{known.index(to.shelf)}}}"), "drop the edits")


def _tried(under: LockedGit, words: Sequence[str], doing: str) -> PicoError | None:
    try:
        under.git(*words, doing=doing)
    except PicoError as exc:
        return exc
    return None


def _shelves(under: LockedGit) -> list[str]:
    return git.run(under.at.root, ["stash", "list", "--format=%H"], doing="list the stash").split()
