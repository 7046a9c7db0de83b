"""What says that PICO has git's lock of the index, and what it is about to write.

A claim is a file of its own, whose kernel lock its process and the git commands that this starts hold: nobody is alive
who works on it if that is free. It is written a line of JSON at a time, each on the disk before what it tells of
begins, so that whoever comes next knows how far a killed one came, and what it wanted. What it names is kept by refs
while it stands, for `git gc` must not take it away.
"""

from __future__ import annotations

import fcntl
import json
import os
import shutil
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pico.disk import write_whole, writing
from pico.history.git import command as git

_KEPT = ("tree", "commit", "only", "shelf")
"""The words of a claim that name objects."""


@dataclass(frozen=True)
class GitFolders:
    """Where git keeps what a commit writes: the top of the working tree, the folder of this worktree, the one that all
    worktrees share, and the index."""

    root: Path
    own: Path
    common: Path
    index: Path

    @property
    def private(self) -> Path:
        """PICO's own folder of this worktree."""
        return self.own / "pico"

    @property
    def claim(self) -> Path:
        """What says that the lock of the index is PICO's: another name of the same file."""
        return self.private / "index.claim"

    @property
    def kept(self) -> str:
        """Where refs keep what the claim names. All worktrees share them: `git gc` in another one sees no others."""
        return f"refs/pico/claims/{'main' if self.own == self.common else f'worktrees/{self.own.name}'}/"

    @property
    def word(self) -> Path:
        """What the guard leaves to be said by the next command."""
        return self.private / "recovered"

    @property
    def lock(self) -> Path:
        """Git's lock of the index."""
        return self.index.with_name(self.index.name + ".lock")


@dataclass(frozen=True)
class Said:
    """What a claim says. `doing`: the command, `pico` its process; `base`: the commit at HEAD before; `refs`: the files
    of the refs that move.

    `trees`: whose files the working tree may hold, more or less, since the claim was made; none where it writes none.
    `to`: where all of it leads, once that is sure; None means back to `base`.
    """

    pico: str = "?"
    doing: str = "pico commit"
    base: str | None = None
    refs: tuple[Path, ...] = ()
    trees: tuple[str, ...] = ()
    to: Goal | None = None

    @property
    def begun(self) -> bool:
        """Whether files may be half written, or index and ref not yet be where they are to go."""
        return bool(self.trees) or self.to is not None


@dataclass(frozen=True)
class Goal:
    """Where index, files and HEAD go: to a `commit`, told in the reflog as `reason`.

    `head`: the ref that HEAD is to name, empty for none (detached), None where it names what it does. `tree`: instead
    of all that, only the files go, to those of a tree. `shelf`: a commit of the stash, which is put there before
    anything goes to a commit, and is taken out when the files have gone to a tree.
    """

    commit: str = ""
    reason: str = ""
    head: str | None = None
    tree: str = ""
    shelf: str = ""


@dataclass
class Claim:
    """A claim that somebody holds. `pending`: files may be half written, so that it must not be given up yet."""

    at: GitFolders
    file: int
    pending: bool = field(default=False)

    @classmethod
    def make(cls, at: GitFolders, doing: str, base: str | None, refs: Sequence[Path]) -> Claim:
        """Make and hold one; raises PicoError."""
        with writing(at.claim, code="folder"):
            at.private.mkdir(parents=True, exist_ok=True)
            at.claim.unlink(missing_ok=True)
            file = os.open(at.claim, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_APPEND | os.O_CLOEXEC, 0o666)
            claim = cls(at, file)
            fcntl.flock(file, fcntl.LOCK_EX)
            claim._say(pico=os.getpid(), doing=doing, base=base, refs=[str(p) for p in refs])
        return claim

    def will_write(self, tree: str) -> None:
        """Say that the files of a tree are about to be written."""
        self.pending = True
        self._say(tree=tree)

    def leads(self, to: Goal, tree: str = "") -> None:
        """Say where it leads for sure, from the files of a tree, if not those of `base`: there is no way back now."""
        self.pending = True
        self._say(
            **({"tree": tree} if tree else {}),
            commit=to.commit,
            reason=to.reason,
            head=to.head,
            only=to.tree,
            shelf=to.shelf,
        )

    def turns_back(self, tree: str) -> None:
        """Say that it leads back after all; the files may be those of a tree."""
        self._say(tree=tree, commit=None)

    def _say(self, **what: Any) -> None:
        for name in filter(None, map(what.get, _KEPT)):
            write_whole(self.at.common / self.at.kept / name, f"{name}\n".encode(), folders=True)
        os.write(self.file, json.dumps(what).encode() + b"\n")
        os.fsync(self.file)

    def said(self) -> Said:
        """Return what it says; a last line that was cut short says nothing."""
        lines = os.pread(self.file, 1 << 20, 0).split(b"\n")
        found: dict[str, Any] = {}
        trees: list[str] = []
        for line in lines[:-1]:
            try:
                told = json.loads(line)
            except ValueError:
                continue
            trees += [told["tree"]] if "tree" in told else []
            found |= told
        if "pico" not in found:
            return Said()
        keys = ("commit", "reason", "head", "only", "shelf")
        to = Goal(*(found[key] for key in keys)) if found.get("commit") is not None else None
        refs = tuple(Path(p) for p in found["refs"])
        return Said(str(found["pico"]), found["doing"], found["base"], refs, tuple(trees), to)


def give_up(at: GitFolders) -> None:
    """Remove a claim, then the refs that keep what it names, those that git has packed, too."""
    at.claim.unlink(missing_ok=True)
    shutil.rmtree(at.common / at.kept, ignore_errors=True)
    if not _may_be_packed(at):
        return
    packed = git.answer(at.root, ["for-each-ref", "--format=delete %(refname)", at.kept])
    if packed:
        words = ["-c", "core.hooksPath=/dev/null", "update-ref", "--stdin"]
        git.run(at.root, words, doing="forget what was to be written", stdin=packed, ends=range(256))


def _may_be_packed(at: GitFolders) -> bool:
    """Return whether git may keep refs of a claim elsewhere than in files of their own."""
    try:
        return at.kept.encode() in (at.common / "packed-refs").read_bytes()
    except FileNotFoundError:
        return (at.common / "reftable").exists()
    except OSError:
        return True
