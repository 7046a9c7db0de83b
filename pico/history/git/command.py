"""The user's own `git`, for what must run hooks, sign and obey configuration. Never through a shell.

A repository's own configuration may name programs, and git runs them: that is wanted where git acts (hooks and filters
of a commit or a checkout), and not where PICO only looks. So what looks runs with hooks, monitors, filters, signature
checks and network turned off (`_guards`), whatever the repository says.
"""

from __future__ import annotations

import errno
import os
import re
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from datetime import timedelta, timezone
from pathlib import Path
from types import MappingProxyType

from pico.base import clock
from pico.diagnostics import PicoError, error
from pico.disk import refusing, spoken, unnamed, unwritable
from pico.history.git.holders import held
from pico.history.git.places import places

# git's words, the code of the diagnostic, and what to do. The first that matches counts.
_KNOWN: tuple[tuple[str, str, str], ...] = (
    (
        r"tell me who you are|empty ident|auto-detect email|user\.useConfigOnly|no email was given",
        "identity",
        'say who you are, once: `git config --global user.name "Your Name"` and '
        "`git config --global user.email you@example.org`",
    ),
    (
        r"Unable to create '[^']*\.lock'|cannot lock ref",
        "git-locked",
        "another git command is running here: wait for it. If none is, remove the lock file that git names",
    ),
    (
        r"would be overwritten|Please commit your changes|Your local changes",
        "dirty",
        "commit the edits (`pico commit`), or shelve them (`git stash`); shelving files moves nothing on the table",
    ),
    (r"dubious ownership", "git-ownership", "the repository belongs to somebody else; git says how to trust it"),
    (r"failed to sign|signing failed|load public key|private key", "git-signing", "see `git config user.signingkey`"),
    (r"nothing to commit|nothing added to commit|no changes added", "nothing-to-commit", "nothing differs from HEAD"),
    (r"partial commit during a", "git-merging", "end the merge first: `git commit`, or `git merge --abort`"),
    (
        r"\[rejected\]|fetch first|non-fast-forward",
        "rejected",
        "somebody pushed before: `pico pull` unites both, then push again",
    ),
    (r"already exists", "exists", "choose another name"),
    (r"not a valid (branch|tag) name|not a valid ref", "name", "use letters, digits, `-`, `_` and `/`"),
)
_LOCK = re.compile(r"Unable to create '([^']*\.lock)'")


# What git's environment says of one repository, and not of another (`git rev-parse --local-env-vars`, in part).
_LOCAL = (
    "GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX", "GIT_COMMON_DIR", "GIT_OBJECT_DIRECTORY",
    "GIT_ALTERNATE_OBJECT_DIRECTORIES",
)  # fmt: skip

# What changes a repository, or speaks to another one: there git does what git does. All else only looks.
_ACTS = frozenset(
    ("add", "bisect", "branch", "checkout", "commit", "config", "maintenance", "merge", "pull", "push", "read-tree",
     "reset", "stash", "tag", "commit-tree", "symbolic-ref", "update-ref")
)  # fmt: skip
_COMPARES = frozenset(("status", "diff", "diff-index", "diff-files"))
"""What reads the files of the working tree through the filters of a repository."""
_ALWAYS = ("-c", "core.fsmonitor=false")
_LOOKING = ("-c", "core.hooksPath=/dev/null", "-c", "log.showSignature=false", "-c", "safe.bareRepository=explicit")
_OFFLINE = {"GIT_ALLOW_PROTOCOL": "none", "GIT_TERMINAL_PROMPT": "0", "GIT_NO_LAZY_FETCH": "1", "GIT_PAGER": "cat"}
_FILTERS = r"^filter\..*\.(clean|smudge|process|required)$"


def run(
    root: Path, arguments: Sequence[str], *, doing: str, stdin: str = "", hook: str | None = None,
    ends: Sequence[int] = (0,), extra: Mapping[str, str] = MappingProxyType({}), inherit: Sequence[int] = (),
    shown: bool = False,
) -> str:  # fmt: skip
    """Run `git ARGUMENTS` in `root` and return what it wrote to standard output.

    `doing` completes "git did not ...". `hook` names the hooks that may refuse it. The environment's GIT_* count,
    and `extra` over them; the open files `inherit` go along; `shown`: it writes its progress to standard error
    itself. Raises PicoError with git's own words and what to do, where it does not end with one of the exit codes
    `ends`.
    """
    options, looking = _guards(root, arguments)
    environment = {**_environment(root), **looking, **extra}
    try:
        done = subprocess.run(
            ["git", *options, *arguments], cwd=root, env=environment, input=os.fsencode(stdin), stdout=subprocess.PIPE,
            stderr=None if shown else subprocess.PIPE, check=False, pass_fds=inherit,
        )  # fmt: skip
    except FileNotFoundError:
        hint = "install git, or add it to PATH"
        raise PicoError(error("git-missing", f"there is no `git` command to {doing}", hint=hint)) from None
    if done.returncode not in ends:
        words = "\n".join(t.decode(errors="replace") for t in (done.stderr, done.stdout) if t)
        raise refusal(
            words.strip(), doing=doing, hook=_installed(root, hook), root=root, acted=not looking or bool(extra)
        )
    return done.stdout.decode(errors="surrogateescape")


def stream(root: Path, arguments: Sequence[str], *, doing: str) -> Iterator[str]:
    """Run `git ARGUMENTS` in `root` and yield the lines that it writes while it runs; ended early, it is ended, too.

    Raises PicoError with git's own words where it fails.
    """
    options, looking = _guards(root, arguments)
    with unnamed() as said:
        try:
            running = subprocess.Popen(
                ["git", *options, *arguments], cwd=root, env={**_environment(root), **looking},
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=said,
            )  # fmt: skip
        except FileNotFoundError:
            hint = "install git, or add it to PATH"
            raise PicoError(error("git-missing", f"there is no `git` command to {doing}", hint=hint)) from None
        assert running.stdout is not None
        try:
            for line in running.stdout:
                yield line.decode(errors="surrogateescape").rstrip("\n")
            if running.wait():
                said.seek(0)
                raise refusal(said.read().decode(errors="replace").strip(), doing=doing, root=root)
        finally:
            running.stdout.close()
            running.kill()
            running.wait()


def answer(root: Path, arguments: Sequence[str]) -> str:
    """Return what `git ARGUMENTS` says, also where it says no: nothing then."""
    return run(root, arguments, doing="answer", ends=range(256))


def given(path: Path) -> tuple[str, Path] | None:
    """Return the repository and the top of its working tree that GIT_DIR names, None where `path` is not below it.

    A hook sets GIT_DIR for its own repository; a lab elsewhere is not part of that.
    """
    folder = os.environ.get("GIT_DIR")
    tree = Path(os.environ.get("GIT_WORK_TREE") or ".").resolve()
    return (str(Path(folder).absolute()), tree) if folder and path.resolve().is_relative_to(tree) else None


def author(root: Path) -> tuple[str, str]:
    """Return whom git would name as the author of a commit made now, and the day (YYYY-MM-DD); raises PicoError."""
    said = run(root, ["var", "GIT_AUTHOR_IDENT"], doing="tell who you are")
    name, _, when = said.strip().rpartition("> ")
    seconds, _, zone = when.partition(" ")
    away = timedelta(hours=int(zone[1:3]), minutes=int(zone[3:5])) * (-1 if zone.startswith("-") else 1)
    day = clock.from_epoch(int(seconds)).astimezone(timezone(away))
    return name.partition(" <")[0], f"{day:%Y-%m-%d}"


def index(root: Path, folder: Path) -> Path:
    """Return the index of the working tree `root`, whose own folder of git is `folder`; GIT_INDEX_FILE counts."""
    told = _environment(root).get("GIT_INDEX_FILE")
    return (root / told).absolute() if told else folder / "index"


def _guards(root: Path, arguments: Sequence[str]) -> tuple[tuple[str, ...], dict[str, str]]:
    """Return the options and the environment that keep git from running what only the repository names."""
    words = (w for i, w in enumerate(arguments) if not w.startswith("-") and (i == 0 or arguments[i - 1] != "-c"))
    command, argument = next(words, ""), next(words, "")
    if command in _ACTS and (command, argument) not in (("stash", "list"), ("bisect", "log")):
        return _ALWAYS, {}
    return (*_ALWAYS, *_LOOKING), _OFFLINE | (_without_filters(root) if command in _COMPARES else {})


def _without_filters(root: Path) -> dict[str, str]:
    """Return the environment that turns off the filters which the repository itself configures; the user's own stay.

    By the environment, not by `-c`: there a name may hold any character.
    """
    if not _may_filter(root):
        return {}
    asked = ["config", "--show-scope", "--name-only", "-z", "--get-regexp", _FILTERS]
    words = run(root, asked, doing="read its configuration", ends=(0, 1)).split("\0")
    pairs = zip(words[::2], words[1::2], strict=False)
    own = dict.fromkeys(name.rpartition(".")[0] for scope, name in pairs if scope in ("local", "worktree"))
    keys = ("clean", ""), ("smudge", ""), ("process", ""), ("required", "false")
    off = [(f"{driver}.{key}", value) for driver in own for key, value in keys]
    told = os.environ.get("GIT_CONFIG_COUNT", "")
    first = int(told) if told.isdigit() else 0
    found = {"GIT_CONFIG_COUNT": str(first + len(off))} if off else {}
    for number, (name, value) in enumerate(off, first):
        found |= {f"GIT_CONFIG_KEY_{number}": name, f"GIT_CONFIG_VALUE_{number}": value}
    return found


def _may_filter(root: Path) -> bool:
    """Return whether the repository's own configuration can name a filter: read from its files, without a process."""
    at = None if given(root) else places(root)
    if at is None:
        return True
    for path in (at.common / "config", at.own / "config.worktree"):
        try:
            text = path.read_bytes().lower()
        except FileNotFoundError:
            continue
        except OSError:
            return True
        if b"filter" in text or b"include" in text:
            return True
    return False


def _environment(root: Path) -> dict[str, str]:
    """Return the environment for git in `root`: without what a hook of another repository set."""
    found = os.environ | {"LC_ALL": "C.UTF-8", "LANGUAGE": "", "GIT_OPTIONAL_LOCKS": "0"}
    told = given(root)
    if told:
        found |= {"GIT_DIR": told[0], "GIT_WORK_TREE": str(told[1])}
    elif "GIT_DIR" in found or not Path.cwd().is_relative_to(root):
        found = {name: value for name, value in found.items() if name not in _LOCAL}
    return found


def hook(
    root: Path, name: str, arguments: Sequence[str], *, doing: str, extra: Mapping[str, str], inherit: Sequence[int]
) -> bool:
    """Run a hook of the repository as git does, and return whether there is one; raises PicoError where it refuses."""
    path = _hook(root, name)
    if path is None:
        return False
    environment = {**_environment(root), **extra}
    words = [str(path), *arguments]
    for command in (words, ["/bin/sh", *words]):  # one without `#!` is for the shell
        try:
            done = subprocess.run(
                command, cwd=root, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT, check=False, pass_fds=inherit,
            )  # fmt: skip
            break
        except OSError as exc:
            if exc.errno != errno.ENOEXEC or command is not words:
                raise PicoError(error("git-hook", f"can't run the {name} hook", detail=str(exc))) from exc
    if done.returncode:
        said = done.stdout.decode(errors="replace").strip()
        raise PicoError(error("git-hook", f"git did not {doing}: its {name} hook refused", detail=said))
    return True


def notify(root: Path, name: str, *arguments: str) -> None:
    """Run a hook that is told of something and can't refuse it."""
    with suppress(PicoError):
        hook(root, name, arguments, doing="", extra={}, inherit=())


def refusal(
    words: str, *, doing: str, hook: str | None = None, root: Path | None = None, acted: bool = False
) -> PicoError:
    """Return the error that says in git's `words` why it did not do what was asked, and what to do about it.

    A lock that is in the way in the working tree `root` is named with who has it. `acted`: git was to write there; a
    full disk may then be the reason that its words do not name.
    """
    if disk := _refused(root if acted else None, words):
        return _on_disk(root or Path(), disk, words, doing)
    for pattern, code, hint in _KNOWN:
        found = re.search(pattern, words, re.IGNORECASE)
        lock = _LOCK.search(words) if found and code == "git-locked" else None
        if lock and root and Path(lock[1]).exists():
            return PicoError(replace(held(Path(lock[1]), root), detail=f"so git did not {doing}"))
        if found:
            said = words.splitlines()[-1] if code == "identity" else words  # before that, git says what the hint says
            return PicoError(error(code, f"git did not {doing}", detail=said, hint=hint))
    if hook:
        return PicoError(error("git-hook", f"git did not {doing}: its {hook} hook refused", detail=words))
    where = f" in {root.absolute()}" if acted and root else ""
    if root and acted and (other := _in_the_way(root)):
        return PicoError(replace(held(other, root), detail=f"so git did not {doing}"))
    return PicoError(error("git", f"git did not {doing}{where}", detail=words))


def _in_the_way(root: Path) -> Path | None:
    """Return the lock of the index where it is there and not PICO's own: `git stash` says nothing of it."""
    lock = root / answer(root, ["rev-parse", "--git-path", "index.lock"]).strip()
    claim = lock.parent / "pico" / "index.claim"
    return lock if lock.is_file() and not (claim.exists() and claim.samefile(lock)) else None


def _refused(root: Path | None, words: str) -> OSError | None:
    """Return what the disk of `root` has against being written, where git's words say so, or say nothing better: a lock
    is in the way, too, that git could not take away on a disk that became read-only."""
    if number := spoken(words):
        return OSError(number, "")
    told = next((code for pattern, code, _ in _KNOWN if re.search(pattern, words, re.IGNORECASE)), "git-locked")
    if root is None or told != "git-locked":
        return None
    own = root / ".git"  # there what a kill leaves of the attempt is in nobody's way
    return refusing(own if own.is_dir() else root)


def _on_disk(root: Path, disk: OSError, words: str, doing: str) -> PicoError:
    what = f"git did not {doing} in {root.absolute()}"
    return PicoError(replace(unwritable(root, disk, what=what, code="git-disk"), detail=words))


def _installed(root: Path, names: str | None) -> str | None:
    """Return which of the hooks in `names` the repository has, or None."""
    return " or ".join(name for name in (names or "").split() if _hook(root, name)) or None


def _hook(root: Path, name: str) -> Path | None:
    """Return the program of a hook, None where the repository has none."""
    asked = subprocess.run(
        ["git", "rev-parse", "--git-path", f"hooks/{name}"], cwd=root, env=_environment(root), capture_output=True,
        text=True, check=False, encoding="utf-8", errors="surrogateescape",
    )  # fmt: skip
    path = root / asked.stdout.strip()
    return path if asked.returncode == 0 and path.is_file() and os.access(path, os.X_OK) else None
