"""Which commands are run at a desk, and with which words: what is not named here is refused before anything starts.

No option names a file, a folder or another bench; what stands without an option may name a file of the desk itself.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from pico.diagnostics import PicoError, did_you_mean, error

MOST, LONGEST = 200, 10_000
"""How many words a command has at most, and how many characters a word."""
_NUMBER = re.compile(r"-[0-9.][0-9.,eE+-]*")
_LONG = {"-m": "--message", "-n": "--number", "-p": "--param"}
_DESKS = ("web/", "detached/")
"""With what the branches begin that desks and detached runs have."""
_TEXT = re.compile(r"[^\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]*")


@dataclass(frozen=True)
class Command:
    """A command that is run at a desk. `options`: those that it takes there, with `=` where a value follows. `lasting`:
    it goes on though nobody listens, and is listed; `prose`: its words are text, and name no files."""

    role: str
    options: frozenset[str]
    lasting: bool = False
    prose: bool = False


def _looks(*options: str) -> Command:
    return Command("viewer", frozenset(options))


def _edits(*options: str, prose: bool = False) -> Command:
    return Command("operator", frozenset(options), prose=prose)


_YES = ("-y", "--yes", "--auto-approve")
_MESSAGE = ("-m=", "--message=")
_MOVING = (*_YES, "--lock-timeout=")
_PLANNING = ("--align", "--no-align", "--exact", "--exclude=", "--prefer=")


def _moves(*options: str, role: str = "operator") -> Command:
    return Command(role, frozenset((*_MOVING, *options)), lasting=True)


COMMANDS: Mapping[str, Command] = {
    "beam": _looks("--manifest", "--source="),
    "blame": _looks("--at=", "--history", "--all"),
    "budget": _looks("--set=", "--for=", "--repeats"),
    "catalog list": _looks(),
    "catalog show": _looks(),
    "catalog parts": _looks("--free"),
    "diff": _looks("--budget=", "--stat", "--exit-code"),
    "doctor": _looks(),
    "drift": _looks("--detailed-exitcode"),
    "get": _looks(),
    "log": _looks("--graph", "--oneline", "--all", "-n=", "--number=", "--since=", "--until=", "--author=", "--grep=",
                  "--first-parent", "--merges", "--no-merges"),
    "look": _looks(),
    "plan": _looks(*_PLANNING, "--explain", "--frames", "--graph", "--detailed-exitcode"),
    "recipe list": _looks(),
    "recipe check": _looks("-p=", "--param="),
    "recipe steps": _looks(),
    "ruler": _looks("--along-beam"),
    "runs list": _looks("--all", "--others", "-n=", "--number="),
    "runs show": _looks("--frames"),
    "runs compare": _looks(),
    "runs pictures": _looks("--of=", "--width="),
    "runs plot": _looks("--x=", "--y=", "--recipe"),
    "show": _looks(),
    "status": _looks("--all"),
    "validate": _looks(),
    "verify": _looks(),
    "capture": _edits("--dry-run"),
    "cherry-pick": _edits("--mainline=", "--no-commit"),
    "commit": _edits(*_MESSAGE, "--capture", "--planned", "--meta=", "--allow-empty"),
    "laser": _looks(),
    "git branch": _edits(),
    "git tag": _edits(),
    "laser disarm": _edits(),
    "merge": _edits(*_MESSAGE),
    "note": _edits(prose=True),
    "revert": _edits(*_MESSAGE, "--mainline=", "--no-commit"),
    "sim bump": _edits("--dx=", "--dy=", "--dz=", "--dyaw="),
    "sim faults": _edits(),
    "sim nudge": _edits("--dx=", "--dy=", "--dyaw="),
    "sim person": _edits(),
    "sim power-cycle": _edits(),
    "sim remove": _edits(),
    "sim reset": _edits("--seed="),
    "sim slip": _edits(),
    "sim upset": _edits(),
    "teleop": Command("teleop", frozenset((*_MOVING, "--begin"))),
    "stash": _edits(*_MESSAGE),
    "apply": _moves(*_PLANNING, "--stop-on-error", "--refresh"),
    "checkout": _moves("--files-only"),
    "do": _moves("--speed=", "--dry-run", "--manifest"),
    "laser arm": Command("laser:enable", frozenset((*_MOVING, "--hours=", "--class=", "--role=", "--unattended",
                                                    "--from="))),
    "measure": _moves("--dry-run"),
    "morning": _moves("--accept", "--detailed-exitcode", "--dry-run"),
    "move": _moves("--speed=", "--dry-run", "--manifest"),
    "optimize": _moves("--algorithm=", "--by-arm", "--dry-run"),
    "recover": _moves("--done=", "--not-done="),
    "resume": _moves("--stop-on-error"),
    "run": _moves("-p=", "--param=", "--dry-run", "--until=", "--resume", "--unattended"),
    "runs replay": _moves(),
    "set": _moves("--dry-run", "--manifest"),
    "redo": _moves("--of="),
    "undo": _moves("--of="),
}  # fmt: skip
"""The commands of a desk by name. Where a role is not enough at the bench, that says so."""


def goes_on(name: str, words: Sequence[str]) -> bool:
    """Return whether a command goes on though nobody listens, and is listed: what only says what it would do, lists
    goals (`optimize` alone), or writes into the manifest alone, does not."""
    lists = name == "optimize" and not words
    return COMMANDS[name].lasting and not lists and not {"--dry-run", "--manifest"} & set(words)


def checked(name: str, words: Sequence[str]) -> tuple[str, ...]:
    """Return the words of a command as they are given to it; raises PicoError for one that it does not take here."""
    command, found, left = COMMANDS[name], list[str](), list(words)
    if name.startswith("git ") and words and words[0].startswith(_DESKS):
        raise _refused(name, f"no name that begins as those of desks do, {', '.join(_DESKS)}")
    if len(left) > MOST:
        raise _refused(name, f"more than {MOST} words")
    while left:
        word = _plain(name, left.pop(0))
        found.append(word)
        if word == "--":
            found += [_beside(name, command, _plain(name, one)) for one in left]
            break
        if not word.startswith("-") or _NUMBER.fullmatch(word):
            _beside(name, command, word)
            continue
        option, equals, _ = word.partition("=")
        takes = f"{option}=" in command.options
        if not takes and option not in command.options:
            hint = did_you_mean(option[:40], {one.rstrip("=") for one in command.options})
            raise _refused(name, f"no option `{option[:40]}`", hint)
        if equals and (not takes or not option.startswith("--")):
            raise _refused(name, f"no value of `{option}` after `=`")
        if takes and not equals:
            if not left or (left[0].startswith("-") and not _NUMBER.fullmatch(left[0])):
                long = _LONG.get(option, option)
                raise _refused(name, f"`{option}` only with a value", f"`{long}=VALUE` where it begins so")
            found.append(_plain(name, left.pop(0)))
    return tuple(found)


def _plain(name: str, word: str) -> str:
    if len(word) > LONGEST or not _TEXT.fullmatch(word):
        raise _refused(name, f"no word of more than {LONGEST} characters, and none that is not text")
    return word


def _beside(name: str, command: Command, word: str) -> str:
    """Return a word that is no option, which names no file outside of the desk; raises PicoError."""
    outside = word.startswith(("/", "~")) or "\\" in word or {"..", ".git"} & set(PurePosixPath(word).parts)
    if outside and not command.prose:
        raise _refused(name, f"no file that is not of the desk, such as `{word[:80]}`")
    return word


def _refused(name: str, what: str, hint: str = "") -> PicoError:
    return PicoError(error("usage", f"at a desk `pico {name}` takes {what}", hint=hint))
