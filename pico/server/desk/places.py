"""Where desks are: worktrees of a lab's bare repository, one of each user on `web/NAME`, and one of each revision that
somebody looks from or runs a recipe at."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from pico.diagnostics import PicoError, error
from pico.manifest.load import labs_below
from pico.server.git.hosting import environment, git

MOST_FILES, MOST_BYTES = 20_000, 512 << 20
"""Files, and their bytes, of a revision that is checked out here."""
KEPT = 40
"""How many worktrees of revisions are kept: more than there are commands at once."""


def desk_of(bare: Path, places: Path, who: str) -> Path:
    """Return the worktree of somebody, on their branch; made where there is none. Raises PicoError."""
    place, branch = places / "of" / who, f"web/{who}"
    if not place.exists():
        start = branch if _has(bare, f"refs/heads/{branch}") else commit_of(bare, None)
        _require_small(bare, start)
        on = [start] if start == branch else ["-b", branch, start]
        _add(bare, place, "--checkout", *on)
    return place


def looking_at(bare: Path, places: Path, commit: str) -> Path:
    """Return a worktree at a commit, made where there is none, in which nothing is changed. Raises PicoError."""
    place = places / "at" / commit
    if place.exists():
        os.utime(place)
        return place
    _require_small(bare, commit)
    _add(bare, place, "--detach", commit)
    others = sorted((p for p in place.parent.iterdir() if p != place), key=lambda p: p.stat().st_mtime)
    for old in others[: -KEPT + 1]:
        remove(bare, old)
    return place


def begun_at(bare: Path, places: Path, commit: str, branch: str) -> Path:
    """Return a worktree on a new branch at a commit. Raises PicoError."""
    place = places / "on" / branch.replace("/", "%")
    _require_small(bare, commit)
    _add(bare, place, "-b", branch, commit)
    return place


def remove(bare: Path, place: Path) -> None:
    """Remove a worktree; what was committed there stays."""
    shutil.rmtree(place, ignore_errors=True)
    git("--git-dir", str(bare), "worktree", "prune")


def commit_of(bare: Path, revision: str | None) -> str:
    """Return the commit of a revision, without one that of the main branch; raises PicoError where there is none."""
    if revision is not None and (found := _resolved(bare, f"refs/heads/{revision}")):  # a tag may be called so, too
        return found
    if found := _resolved(bare, revision or "HEAD"):
        return found
    if revision is None:
        heads = git("--git-dir", str(bare), "for-each-ref", "--format=%(refname)", "refs/heads").split()
        if len(heads) == 1 and (found := _resolved(bare, heads[0])):
            return found
        text = f"{bare.stem} has no branch main here yet"
        raise PicoError(error("revision", text, hint=f"`git push URL/api/git/{bare.stem} main`, once"))
    raise PicoError(error("revision", f"there is no commit {revision[:80]!r} here", hint="push it first"))


def lab_in(place: Path, lab: str) -> Path:
    """Return the folder of a lab in a worktree; raises PicoError where there is none, or several and none so called."""
    found = labs_below(place)
    named = [folder for folder in found if folder.name == lab]
    if len(found) == 1 or len(named) == 1:
        return (named or found)[0]
    what = "several labs" if found else "no lab"
    raise PicoError(error("no-lab", f"the repository of {lab} holds {what}", hint=f"one in a folder called {lab}"))


def _add(bare: Path, place: Path, *words: str) -> None:
    place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    git("--git-dir", str(bare), "worktree", "prune")
    git("--git-dir", str(bare), "worktree", "add", "--quiet", *words[:-1], str(place), words[-1])


def _has(bare: Path, reference: str) -> bool:
    return bool(git("--git-dir", str(bare), "for-each-ref", "--format=%(refname)", reference))


def _resolved(bare: Path, revision: str) -> str | None:
    try:
        return git(
            "--git-dir", str(bare), "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}"
        )
    except PicoError:
        return None


def _require_small(bare: Path, revision: str) -> None:
    """Raise PicoError for a revision with more files or bytes than are checked out here: a small push can name them."""
    words = ["git", "--git-dir", str(bare), "ls-tree", "-r", "-l", "-z", "--full-tree", "--end-of-options", revision]
    files = size = 0
    with subprocess.Popen(words, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        assert process.stdout is not None
        rest = b""
        while piece := process.stdout.read(1 << 16):
            *entries, rest = (rest + piece).split(b"\0")
            files += len(entries)
            size += sum(int(length) for e in entries if (length := e.split(b"\t")[0].split()[3]).isdigit())
            if files > MOST_FILES or size > MOST_BYTES:
                process.kill()
                text = f"{revision[:60]} has more than {MOST_FILES} files or {MOST_BYTES >> 20} MiB"
                raise PicoError(error("too-long", text, hint="`pico data` keeps large data beside the commits"))
