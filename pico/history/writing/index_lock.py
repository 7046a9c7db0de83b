"""Git's `index.lock`, taken by PICO in such a way that one left by a killed `pico commit` is known for what it is.

The lock is a hard link to a file of PICO's own (the claim), whose kernel lock the process and the git commands that it
starts hold: it is ours if both are one file, and nobody is alive who has it if that kernel lock is free. A lock of
anybody else's is named and left.
"""

from __future__ import annotations

import fcntl
import json
import os
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.history import git

WAIT = 10.0
"""Seconds that somebody else's lock is waited for; git holds one for milliseconds, unless an editor is open."""
SETTLED = 1.0
"""Seconds for which the lock of a ref must not change to be called left over; git holds one for milliseconds."""
_RETRY = 0.02


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
    def lock(self) -> Path:
        """Git's lock of the index."""
        return self.index.with_name(self.index.name + ".lock")


@contextmanager
def index_lock(at: GitFolders, base: str | None, refs: Sequence[Path]) -> Iterator[int]:
    """Hold the lock of the index; yields the open file that the git commands which are started must inherit.

    Call it under the lock of writers, after `recover`. `base`: the commit at HEAD; `refs`: the files of the refs that
    are about to move. Raises PicoError where somebody else holds it for longer than WAIT.
    """
    path = at.claim
    file = _claimed(path, base, refs)
    linked = True
    try:
        linked = _link(at, path, WAIT)
        yield file
    finally:
        if not linked or _same(path, at.lock):
            at.lock.unlink(missing_ok=True)
        path.unlink(missing_ok=True)
        os.close(file)


def _claimed(path: Path, base: str | None, refs: Sequence[Path]) -> int:
    """Make the claim, which says what it is about to change, and lock it."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    except OSError as exc:
        raise PicoError(error("folder", f"can't write {path}: {(exc.strerror or str(exc)).lower()}")) from exc
    fcntl.flock(file, fcntl.LOCK_EX)
    says = {"pico": os.getpid(), "base": base, "refs": [str(p) for p in refs]}
    os.pwrite(file, json.dumps(says).encode(), 0)
    return file


def _link(at: GitFolders, path: Path, seconds: float) -> bool:
    """Take git's lock as a hard link; return False where the file system has none, and it is a file like git's own."""
    deadline = time.monotonic() + seconds
    while True:
        with suppress(FileExistsError):
            try:
                os.link(path, at.lock)
                return True
            except FileExistsError:
                raise
            except OSError:
                _make(at.lock)
                return False
        if time.monotonic() >= deadline:
            raise PicoError(_held(at.lock, at.root, seconds))
        time.sleep(_RETRY)


def _make(lock: Path) -> None:
    try:
        os.close(os.open(lock, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    except FileExistsError:
        raise
    except OSError as exc:
        raise PicoError(error("folder", f"can't make {lock}: {(exc.strerror or str(exc)).lower()}")) from exc


def recover(at: GitFolders) -> tuple[Diagnostic, ...]:
    """Clear what a killed `pico commit` left, once no git command that it started lives any more; return what that was.

    Call it under the lock of writers. Raises PicoError where such a command goes on for longer than WAIT.
    """
    return tuple(_recovered(at, at.claim, WAIT)) if at.claim.exists() else ()


def _recovered(at: GitFolders, path: Path, seconds: float) -> Iterator[Diagnostic]:
    try:
        file = os.open(path, os.O_RDWR | os.O_CLOEXEC)
    except OSError:
        return
    try:
        _await_death(file, path, seconds)
        who, refs, base = _read(file)
        for lock in (p.with_name(p.name + ".lock") for p in refs):
            if _of_ours(at.root, lock, base) and _left_over(lock, path):
                lock.unlink(missing_ok=True)
                yield _removed(lock, who)
        for private in at.private.glob("index*.lock"):
            private.unlink(missing_ok=True)
        _clear_next(at.own)
        if _same(path, at.lock):
            at.lock.unlink()
            yield _removed(at.lock, who)
        path.unlink(missing_ok=True)
    finally:
        os.close(file)


def _await_death(file: int, path: Path, seconds: float) -> None:
    deadline = time.monotonic() + seconds
    while True:
        with suppress(BlockingIOError):
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        if time.monotonic() >= deadline:
            text = "a git command of a `pico commit` that was killed is still running here"
            hint = f"`fuser {path}` names it; wait for it, or end it"
            raise PicoError(error("git-locked", text, hint=hint))
        time.sleep(_RETRY)


def _read(file: int) -> tuple[str, list[Path], str | None]:
    """Return what a claim says: its process, the files of the refs it was about to move, and the commit before."""
    try:
        says = json.loads(os.pread(file, 65536, 0))
        return str(says["pico"]), [Path(p) for p in says["refs"]], says["base"]
    except (ValueError, KeyError, TypeError):
        return "?", [], None


def _of_ours(root: Path, lock: Path, base: str | None) -> bool:
    """Whether the lock of a ref names nothing yet, or a commit on the one that ours was to follow."""
    try:
        name = lock.read_text(encoding="ascii").strip()
        if not name:
            return True
        _, *parents = git.run(root, ["rev-list", "--parents", "-n1", name], doing="read a commit").split()
    except (OSError, ValueError, PicoError):
        return False
    return parents[:1] == ([base] if base else [])


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


def _alive(process: int) -> bool:
    """Whether a process runs; one that ended and whose parent has not asked yet does not (Linux tells)."""
    try:
        os.kill(process, 0)
        said = Path(f"/proc/{process}/stat").read_text(errors="replace")
        return said.rpartition(")")[2].split()[0] != "Z"
    except ProcessLookupError:
        return False
    except (OSError, OverflowError, IndexError):
        return True


def _same(a: Path, b: Path) -> bool:
    try:
        return a.samefile(b)
    except OSError:
        return False


def _removed(lock: Path, who: str) -> Diagnostic:
    return warning("stale-lock", f"removed {lock}, which a `pico commit` left that was killed (process {who})")


def _held(lock: Path, root: Path, seconds: float) -> Diagnostic:
    """Say who holds a lock that is not ours, as far as that can be told."""
    try:
        age = time.time() - lock.stat().st_mtime
    except OSError:
        age = 0.0
    running = _git_processes(root)
    who = f"held by {running[0]}" if running else "no git command is seen running here"
    hint = "end that command, or close its editor" if running else f"if none is running anywhere: `rm {lock}`"
    text = f"{lock} is there for {age:.0f} s, and not of PICO's making: {who}; it was waited for {seconds:g} s"
    return error("git-locked", text, hint=hint)


def _git_processes(root: Path) -> list[str]:
    """Return the git commands that run in a working tree, as the kernel shows them (Linux; nothing elsewhere)."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
            if words[0].rsplit(b"/", 1)[-1] == b"git" and (folder / "cwd").resolve().is_relative_to(root):
                said = b" ".join(words[:3]).decode(errors="replace").strip()
                found.append(f"`{said}` (process {folder.name})")
        except OSError:
            continue
    return found
