"""How files, index and HEAD go from one commit to another, so that a kill at any instant leaves nothing in between.

What is to come lies in objects first, the finished commit included; then the claim says so; then, under git's lock of
the index, files follow, then the index, then HEAD, which moves only from where it was. Killed before the commit is
said, the files go back; killed after it, everything goes on to it (`settle`): the guard or the next command does what
the killed one would have done. MERGE_HEAD is never written, so that no commit of plain git can record a merge whose
content is not there.

Hooks see what they are to judge: files and an index as the commit will have them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from pico.diagnostics import PicoError
from pico.history.git import command as git
from pico.history.writing.claim import Claim, GitFolders, Goal, Said
from pico.history.writing.commit_object import NewCommit, make
from pico.history.writing.index_lock import index_lock
from pico.history.writing.locked_git import LockedGit, listed
from pico.history.writing.shelving import dropped, shelf, stored
from pico.history.writing.worktree import bring

_HOOK = "reference-transaction"
_FILES = "index.files"
"""The index that holds the tree of the files, and nothing else."""


@dataclass(frozen=True)
class SettledClaim:
    """How a claim was brought to its end: `there`, at its goal, else back. `kept`: files left as somebody edited them;
    `why`: what kept HEAD from moving."""

    there: bool = False
    kept: tuple[str, ...] = ()
    why: PicoError | None = None


@dataclass(frozen=True)
class Start:
    """Where a passage begins: the commit at HEAD, the files of the refs that move, the command as a person says it."""

    base: str
    refs: tuple[Path, ...]
    doing: str


def advance(at: GitFolders, start: Start, steps: Sequence[NewCommit], reason: str) -> tuple[str, ...]:
    """Make commits one on the other, let files, index and HEAD go to the last one, and return their ids.

    What else is staged stays staged, what else was edited stays edited. Raises PicoError, with everything as it was,
    where a file that would be overwritten holds what git does not keep, where a hook refuses one of the commits, and in
    git's words.
    """
    made: list[str] = []

    def work(claim: Claim) -> None:
        files = LockedGit(at, claim, _FILES)
        for step in steps:
            _restaged(LockedGit(at, claim), start.base, step.tree)
            bring(files, (start.base, *claim.said().trees), step.tree, partial(claim.will_write, step.tree))
            made.append(make(files, step, (start.base, *made)[-1]))
            claim.will_write(made[-1])  # a hook may have changed the files
        claim.leads(Goal(made[-1], reason))

    _pass(at, start, work)
    for step in steps:
        git.notify(at.root, *(("post-merge", "0") if step.merges else ("post-commit",)))
    return tuple(made)


def go(at: GitFolders, start: Start, to: Goal) -> None:
    """Let files, index and HEAD go from one commit to another; raises PicoError as `advance` does."""

    def work(claim: Claim) -> None:
        _restaged(LockedGit(at, claim), start.base, to.tree or to.commit)
        bring(LockedGit(at, claim, _FILES), (start.base,), to.tree or to.commit, lambda: claim.leads(to))

    _pass(at, start, work)


def shelve(at: GitFolders, start: Start, paths: Sequence[str], message: str) -> None:
    """Put the files `paths` into git's stash, and let them be as in the commit at HEAD; raises PicoError."""

    def work(claim: Claim) -> None:
        made, tree = shelf(at, claim, start.base, paths, message)
        claim.leads(Goal(start.base, shelf=made), tree)

    _pass(at, start, work)


def _pass(at: GitFolders, start: Start, work: Callable[[Claim], None]) -> None:
    with index_lock(at, start.doing, start.base, start.refs) as claim:
        try:
            work(claim)
        finally:
            settled = settle(at, claim)
    if settled.why:
        raise settled.why


def settle(at: GitFolders, claim: Claim) -> SettledClaim:
    """Bring what a claim tells of to its end: on to where it leads, else back. Doing it twice does it once.

    The claim may be given up after it. Raises PicoError where that can't be done now (a full disk).
    """
    said, done = claim.said(), SettledClaim()
    if said.begun and said.base:
        done = _onwards(at, claim, said, said.base, said.to) if said.to else _back(at, claim, said, said.base)
    (at.private / _FILES).unlink(missing_ok=True)
    claim.pending = False
    return done


def _onwards(at: GitFolders, claim: Claim, said: Said, base: str, to: Goal) -> SettledClaim:
    index = LockedGit(at, claim)
    if to.shelf and not to.tree and (why := stored(index, to)):
        return SettledClaim(why=why)  # the edits stay where they are
    kept = bring(LockedGit(at, claim, _FILES), (base, *said.trees), to.tree or to.commit)
    if to.tree:
        return SettledClaim(True, kept, dropped(index, to) if to.shelf else None)
    if to.shelf:
        _unstaged(index, said.trees, base)
    else:
        _restaged(index, base, to.commit)
    index.adopt()
    try:
        _move_head(index, base, to)
    except PicoError as exc:
        claim.turns_back(to.commit)
        return replace(_back(at, claim, claim.said(), base), why=exc)
    return SettledClaim(True, kept)


def _back(at: GitFolders, claim: Claim, said: Said, base: str) -> SettledClaim:
    kept = bring(LockedGit(at, claim, _FILES), said.trees, base)
    index = LockedGit(at, claim)
    _restaged(index, said.trees[-1], base)
    index.adopt()
    return SettledClaim(False, kept)


def _restaged(index: LockedGit, before: str, after: str) -> None:
    """Make an index as git's own, with what leads from one tree to another; what else is staged in it stays.

    Raises PicoError where what is staged would be lost.
    """
    index.begin()
    index.git("read-tree", "-m", "-i", before, after, doing="stage the files of a commit")
    index.git("update-index", "-q", "--refresh", doing="look at the files", ends=(0, 1))


def _unstaged(index: LockedGit, trees: Sequence[str], base: str) -> None:
    """Make an index as git's own, in which files that trees hold otherwise are as in `base`."""
    index.begin()
    for tree in trees:
        words = ["diff-tree", "-r", "-z", "--name-only", "--no-renames", tree, base]
        paths = index.git(*words, doing="compare two commits").split("\0")[:-1]
        if paths:
            index.git("reset", "--quiet", base, *listed(index.at, paths), doing="take back what was staged")


def _move_head(index: LockedGit, base: str, to: Goal) -> None:
    """Let HEAD, and the branch that it names, go from `base` to a goal, where it has not done so already."""
    root = index.at.root
    now = git.answer(root, ["rev-parse", "--verify", "--quiet", "HEAD"]).strip()
    names = git.answer(root, ["symbolic-ref", "--quiet", "HEAD"]).strip()
    if now == to.commit and to.head in (None, names):
        return
    if to.head is None:
        words = f"update HEAD {to.commit} {base}\nupdate ORIG_HEAD {base}\n"
        index.git("update-ref", "-m", to.reason, "--stdin", doing="move the branch", stdin=words, hook=_HOOK)
    elif to.head:
        index.git("symbolic-ref", "-m", to.reason, "HEAD", to.head, doing="change the branch", hook=_HOOK)
    else:
        words = f"update HEAD {to.commit} {base}\n"
        index.git("update-ref", "--no-deref", "-m", to.reason, "--stdin", doing="move HEAD", stdin=words, hook=_HOOK)
