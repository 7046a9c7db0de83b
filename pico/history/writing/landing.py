"""How a commit gets into the repository: in an order in which a kill at any instant loses and reverses nothing.

Objects, then the index, then the ref: git adds what is to be committed to a copy of the index, which takes the place of
the index before git commits. Killed before that, HEAD and index are as they were and the files hold honest edits;
killed after it, changes are staged, or the commit is there. Were the ref first, the index would stage its reversal.
The lock of the index is held throughout, so that no other git command comes in between; git itself reads HEAD, builds
the tree on it, runs hooks, signs, and moves the ref only from where it was.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from pico.diagnostics import PicoError
from pico.history.git import command as git
from pico.history.writing.claim import GitFolders
from pico.history.writing.index_lock import index_lock
from pico.history.writing.locked_git import LockedGit, copy_index, list_of, listed

_LATER = ("-c", "maintenance.auto=false")
"""What git tidies up may take minutes, and nobody is to wait for that; it comes when the locks are free again."""
_HOOKS = "pre-commit commit-msg prepare-commit-msg"


@dataclass(frozen=True)
class Landing:
    """What to commit: `paths` from the top of the working tree, and those of them that .gitignore may name (`ignored`).

    `partial`: nothing else that is staged; else all of that, as the commit that ends a merge needs it. `head`: the
    commit at HEAD; `refs`: the files of the refs that move. `options`: more that `git commit` is told. `tidy`: let git
    pack its objects where it finds it time.
    """

    message: str
    paths: tuple[str, ...]
    ignored: tuple[str, ...] = ()
    head: str | None = None
    refs: tuple[Path, ...] = ()
    partial: bool = True
    options: tuple[str, ...] = ()
    tidy: bool = True


def land(at: GitFolders, what: Landing) -> None:
    """Commit. Raises PicoError with git's words; index and HEAD are then as they were."""
    with index_lock(at, "pico commit", what.head, what.refs) as claim:
        before, under = at.private / "index.before", LockedGit(at, claim)
        try:
            copy_index(at.index, before)
            _stage(under, what)
            _commit(under, what)
        except PicoError:
            _put_back(at, before, what.head)
            raise
        finally:
            before.unlink(missing_ok=True)
            list_of(at).unlink(missing_ok=True)
    if what.tidy:
        git.answer(at.root, ["maintenance", "run", "--auto", "--quiet"])


def _stage(under: LockedGit, what: Landing) -> None:
    """Add to a copy of the index, and let that take the index's place."""
    under.begin()
    plain = tuple(path for path in what.paths if path not in what.ignored)
    for names, options in ((plain, ()), (what.ignored, ("--force",))):
        if names:
            under.git("add", "--all", *options, *listed(under.at, names), doing="stage the manifests")
    under.adopt()


def _commit(under: LockedGit, what: Landing) -> None:
    under.begin()
    only = ["--only", *(listed(under.at, what.paths) if what.paths else ())] if what.partial else []
    arguments = [*_LATER, "commit", "--quiet", "--file=-", *what.options, *only]
    under.git(*arguments, doing="commit", stdin=what.message, hook=_HOOKS)
    _follow_hooks(under, what)
    under.adopt()


def _follow_hooks(under: LockedGit, what: Landing) -> None:
    """Let the index have what a hook made of the files: the commit has it, and the index would stage its reversal."""
    asked = ["diff-index", "--cached", "--name-only", "-z", "HEAD"]
    differ = set(under.git(*asked, doing="read the index").split("\0")) & set(what.paths)
    if differ:
        under.git("reset", "--quiet", *listed(under.at, tuple(sorted(differ))), doing="follow the hooks")


def _put_back(at: GitFolders, before: Path, head: str | None) -> None:
    """Let the index be as it was, where no commit came about."""
    now = git.answer(at.root, ["rev-parse", "--quiet", "--verify", "HEAD"]).strip()
    if now != (head or ""):
        return
    if before.exists():
        before.replace(at.index)
    else:
        at.index.unlink(missing_ok=True)
