"""What a killed command left, brought to its end: locks cleared, files neither half old nor half new."""

from __future__ import annotations

import fcntl
import os
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.history.git import command as git
from pico.history.git.places import places
from pico.history.writing import index_lock
from pico.history.writing.claim import Claim, GitFolders, Goal, Said
from pico.history.writing.locked_git import list_of
from pico.history.writing.passage import settle

SETTLED = 1.0
"""Seconds for which the lock of a ref must not change to be called left over; git holds one for milliseconds."""
_RETRY = 0.02


def recover(at: GitFolders) -> tuple[Diagnostic, ...]:
    """Bring to its end what a killed command left, once no git command that it started lives any more.

    Returns what that was, and what the guard did of it. Call it under the lock of writers. Raises PicoError where such
    a git command goes on for longer than WAIT, and where it can't be brought to its end.
    """
    found: list[Diagnostic] = []
    _recovered(at, found.extend)
    return (*_word_left(at), *found)


def leave_word(at: GitFolders) -> None:
    """Recover, and leave what there is to say to whoever asks next."""

    def leave(found: list[Diagnostic]) -> None:
        fresh = at.word.with_suffix(".new")
        fresh.write_text("\n".join(d.summary for d in found), encoding="utf-8")
        fresh.replace(at.word)

    _recovered(at, leave)


def anything_left(folder: Path) -> bool:
    """Whether there is something to recover in the working tree around a folder, or to be told of it; what a command
    that lives is about is not. Costs next to nothing."""
    found = places(folder)
    if found is None:
        return False
    at = GitFolders(found.top, found.own, found.common, found.own / "index")
    return at.word.exists() or (at.claim.exists() and _given_up(at.claim))


def _word_left(at: GitFolders) -> Iterator[Diagnostic]:
    with suppress(FileNotFoundError):
        said = at.word.read_text(encoding="utf-8", errors="replace").splitlines()
        at.word.unlink(missing_ok=True)
        yield from (warning("recovered", line) for line in said)


def _given_up(path: Path) -> bool:
    try:
        file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return True
    except BlockingIOError:
        return False
    finally:
        os.close(file)


def _recovered(at: GitFolders, tell: Callable[[list[Diagnostic]], None]) -> None:
    """Recover, and tell what that was before the claim is given up."""
    try:
        file = os.open(at.claim, os.O_RDWR | os.O_APPEND | os.O_CLOEXEC)
    except OSError:
        return
    try:
        _await_death(file, at.claim)
        claim = Claim(at, file)
        tell(list(_ended(at, claim, claim.said())))
        index_lock.release(at)
    finally:
        os.close(file)


def _ended(at: GitFolders, claim: Claim, said: Said) -> Iterator[Diagnostic]:
    """Clear locks, settle what a claim tells of, and yield what came of it."""
    for lock in (p.with_name(p.name + ".lock") for p in said.refs):
        if _of_ours(at.root, lock, said) and _left_over(lock, at.claim):
            lock.unlink(missing_ok=True)
            yield _removed(lock, said)
    _clear_next(at.own)
    _clear_own(at)
    if not said.begun:
        yield from [_removed(at.lock, said)] if index_lock.taken(at) else []
        return
    index_lock.take(at)  # somebody may have removed it by hand
    what = f"`{said.doing}`, which was killed (process {said.pico})"
    if why := _hopeless(at.root, said):
        yield warning("recovered", f"{why} {what}: gave that up; HEAD, index and files stay as they are (`git status`)")
        return
    done = settle(at, claim)
    yield warning("recovered", f"finished {what}" if done.there else f"took back what was half written by {what}")
    if done.kept:
        text = f"{', '.join(done.kept)} left as edited since; `git diff` shows how"
        yield warning("recovered", text)


def _hopeless(root: Path, said: Said) -> str:
    """Return why a claim can't be brought to its end, if so: somebody went on by plain git, so that HEAD is neither
    where it found it nor where it leads; or took away objects that it names."""
    now = git.answer(root, ["rev-parse", "--verify", "--quiet", "HEAD"]).strip()
    to = said.to or Goal()
    if said.base and now not in (said.base, to.commit or said.base):
        return "HEAD moved since"
    named = [name for name in (said.base, *said.trees, to.commit, to.tree, to.shelf) if name]
    told = git.run(root, ["cat-file", "--batch-check"], doing="look for objects", stdin="\n".join(named))
    return "git has lost objects of" if " missing" in told else ""


def _await_death(file: int, path: Path) -> None:
    deadline = time.monotonic() + index_lock.WAIT
    while True:
        with suppress(BlockingIOError):
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        if time.monotonic() >= deadline:
            text = "a git command of a `pico` that was killed is still running here"
            hint = f"`fuser {path}` names it; wait for it, or end it"
            raise PicoError(error("git-locked", text, hint=hint))
        time.sleep(_RETRY)


def _of_ours(root: Path, lock: Path, said: Said) -> bool:
    """Whether the lock of a ref names nothing yet, or what ours was to say: a commit on the one before, or the goal."""
    try:
        name = lock.read_text(encoding="ascii").strip()
        if (
            not name
            or lock.name == "stash.lock"
            or name == said.base
            or (said.to and name in (said.to.commit, f"ref: {said.to.head}"))
        ):
            return True
        _, *parents = git.run(root, ["rev-list", "--parents", "-n1", name], doing="read a commit").split()
    except (OSError, ValueError, PicoError):
        return False
    return parents[:1] == ([said.base] if said.base else [])


def _left_over(lock: Path, claim: Path) -> bool:
    """Whether the lock of a ref was made after a claim, and does not change for longer than anybody alive needs it."""
    try:
        before = lock.lstat()
        if before.st_mtime_ns < claim.stat().st_mtime_ns:
            return False
        deadline = time.monotonic() + SETTLED
        while time.monotonic() < deadline:
            time.sleep(_RETRY)
            now = lock.lstat()
            if (now.st_ino, now.st_mtime_ns, now.st_size) != (before.st_ino, before.st_mtime_ns, before.st_size):
                return False
        return True
    except FileNotFoundError:
        return False


def _clear_next(own: Path) -> None:
    """Remove the temporary indexes of git commands that live no more."""
    for path in own.glob("next-index-*.lock"):
        number = path.name.removeprefix("next-index-").removesuffix(".lock")
        if number.isdigit() and not _alive(int(number)):
            path.unlink(missing_ok=True)


def _clear_own(at: GitFolders) -> None:
    """Remove PICO's own indexes and files on their way, of which the claim tells where they come from."""
    for path in at.private.glob("index*"):
        if path != at.claim:
            path.unlink(missing_ok=True)
    list_of(at).unlink(missing_ok=True)
    shutil.rmtree(at.private / "files", ignore_errors=True)


def _alive(process: int) -> bool:
    """Whether a process runs; one that ended and whose parent has not asked yet does not (Linux tells)."""
    try:
        os.kill(process, 0)
        said = Path(f"/proc/{process}/stat").read_text(errors="replace", encoding="utf-8")
        return said.rpartition(")")[2].split()[0] != "Z"
    except ProcessLookupError:
        return False
    except (OSError, OverflowError, IndexError):
        return True


def _removed(lock: Path, said: Said) -> Diagnostic:
    return warning("stale-lock", f"removed {lock}, which a `{said.doing}` left that was killed (process {said.pico})")
