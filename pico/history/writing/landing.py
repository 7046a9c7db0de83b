"""How a commit gets into the repository: in an order in which a kill at any instant loses and reverses nothing.

Objects, then the index, then the ref: git adds what is to be committed to a copy of the index, which takes the place of
the index before git commits. Killed before that, HEAD and index are as they were and the files hold honest edits;
killed after it, changes are staged, or the commit is there. Were the ref first, the index would stage its reversal.
The lock of the index is held throughout, so that no other git command comes in between; git itself reads HEAD, builds
the tree on it, runs hooks, signs, and moves the ref only from where it was.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from pico.diagnostics import PicoError
from pico.history import git
from pico.history.writing.index_lock import GitFolders, index_lock

_SAFE = ("-c", "core.fsync=committed,loose-object,index,reference", "-c", "core.filesRefLockTimeout=5000")
"""Objects, index and refs are on the disk before what refers to them; refs that others hold are waited for."""
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
    with index_lock(at, what.head, what.refs) as claim:
        before = at.private / "index.before"
        _copy(at.index, before)
        try:
            _stage(at, claim, what)
            _commit(at, claim, what)
        except PicoError:
            _put_back(at, before, what.head)
            raise
        finally:
            before.unlink(missing_ok=True)
            _list_of(at).unlink(missing_ok=True)
    if what.tidy:
        git.answer(at.root, ["maintenance", "run", "--auto", "--quiet"])


def _stage(at: GitFolders, claim: int, what: Landing) -> None:
    """Add to a copy of the index, and let that take the index's place."""
    _copy(at.index, at.private / "index")
    plain = tuple(path for path in what.paths if path not in what.ignored)
    for names, options in ((plain, ()), (what.ignored, ("--force",))):
        if names:
            _git(at, claim, ["add", "--all", *options, *_listed(at, names)], doing="stage the manifests")
    (at.private / "index").replace(at.index)


def _commit(at: GitFolders, claim: int, what: Landing) -> None:
    _copy(at.index, at.private / "index")
    only = ["--only", *_listed(at, what.paths)] if what.partial else []
    arguments = [*_LATER, "commit", "--quiet", "--file=-", *what.options, *only]
    _git(at, claim, arguments, doing="commit", stdin=what.message, hook=_HOOKS)
    _follow_hooks(at, claim, what)
    (at.private / "index").replace(at.index)


def _follow_hooks(at: GitFolders, claim: int, what: Landing) -> None:
    """Let the index have what a hook made of the files: the commit has it, and the index would stage its reversal."""
    asked = ["diff-index", "--cached", "--name-only", "-z", "HEAD"]
    differ = set(_git(at, claim, asked, doing="read the index").split("\0")) & set(what.paths)
    if differ:
        _git(at, claim, ["reset", "--quiet", *_listed(at, tuple(sorted(differ)))], doing="follow the hooks")


def _put_back(at: GitFolders, before: Path, head: str | None) -> None:
    """Let the index be as it was, where no commit came about."""
    now = git.answer(at.root, ["rev-parse", "--quiet", "--verify", "HEAD"]).strip()
    if now != (head or ""):
        return
    if before.exists():
        before.replace(at.index)
    else:
        at.index.unlink(missing_ok=True)


def _git(
    at: GitFolders, claim: int, arguments: Sequence[str], *, doing: str, stdin: str = "", hook: str | None = None
) -> str:
    extra = {"GIT_INDEX_FILE": str(at.private / "index")}
    return git.run(at.root, [*_SAFE, *arguments], doing=doing, stdin=stdin, hook=hook, extra=extra, inherit=(claim,))


def _listed(at: GitFolders, paths: Sequence[str]) -> tuple[str, str]:
    """Write paths into a file, for they may be many, and return the options that name it; each stands for itself."""
    names = (f":(top,literal){path}" if path != "." else ":(top)" for path in paths)
    _list_of(at).write_bytes(b"\0".join(os.fsencode(name) for name in names))
    return f"--pathspec-from-file={_list_of(at)}", "--pathspec-file-nul"


def _list_of(at: GitFolders) -> Path:
    return at.private / "paths"


def _copy(source: Path, target: Path) -> None:
    """Copy an index with its times, by which git knows which files it must look into; none where there is none."""
    target.with_name(target.name + ".lock").unlink(missing_ok=True)
    if source.exists():
        shutil.copy2(source, target)
    else:
        target.unlink(missing_ok=True)
