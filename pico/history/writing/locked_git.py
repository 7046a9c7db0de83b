"""Git commands that are run while PICO has the lock of the index: on an index of PICO's own, and known as its own."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from pico.history.git import command as git
from pico.history.writing.claim import Claim, GitFolders

_SAFE = ("-c", "core.fsync=committed,loose-object,index,reference", "-c", "core.filesRefLockTimeout=5000")
"""Objects, index and refs are on the disk before what refers to them; refs that others hold are waited for."""


@dataclass(frozen=True)
class LockedGit:
    """Runs git under a claim, on the index `name` in PICO's own folder: the lock of git's own index is taken."""

    at: GitFolders
    claim: Claim
    name: str = "index"

    @property
    def index(self) -> Path:
        """The index that git is told of."""
        return self.at.private / self.name

    def on(self, name: str) -> LockedGit:
        """Return the same with another index."""
        return LockedGit(self.at, self.claim, name)

    def git(
        self, *arguments: str, doing: str, stdin: str = "", hook: str | None = None, ends: Sequence[int] = (0,),
        extra: Mapping[str, str] = MappingProxyType({}),
    ) -> str:  # fmt: skip
        """Run `git ARGUMENTS` and return what it says; raises PicoError as `pico.history.git.command.run` does."""
        return git.run(
            self.at.root, [*_SAFE, *arguments], doing=doing, stdin=stdin, hook=hook, ends=ends,
            extra={**extra, "GIT_INDEX_FILE": str(self.index)}, inherit=(self.claim.file,),
        )  # fmt: skip

    def hook(self, name: str, *arguments: str, doing: str) -> bool:
        """Run a hook, if there is one, as git would for a commit; raises PicoError where it refuses."""
        extra = {"GIT_INDEX_FILE": str(self.index), "GIT_EDITOR": ":"}
        return git.hook(self.at.root, name, arguments, doing=doing, extra=extra, inherit=(self.claim.file,))

    def begin(self) -> None:
        """Let the index be a copy of git's own, with its times, by which git knows which files it must look into."""
        copy_index(self.at.index, self.index)

    def adopt(self) -> None:
        """Let the index take the place of git's own."""
        self.index.replace(self.at.index)


def copy_index(source: Path, target: Path) -> None:
    """Copy an index with its times; none where there is none."""
    target.with_name(target.name + ".lock").unlink(missing_ok=True)
    if source.exists():
        shutil.copy2(source, target)
    else:
        target.unlink(missing_ok=True)


def listed(at: GitFolders, paths: Sequence[str]) -> tuple[str, str]:
    """Write paths into a file, for they may be many, and return the options that name it; each stands for itself."""
    names = (f":(top,literal){path}" if path != "." else ":(top)" for path in paths)
    list_of(at).write_bytes(b"\0".join(os.fsencode(name) for name in names))
    return f"--pathspec-from-file={list_of(at)}", "--pathspec-file-nul"


def list_of(at: GitFolders) -> Path:
    """Return the file that `listed` writes."""
    return at.private / "paths"
