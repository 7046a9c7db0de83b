"""Commands that are printed reach the bench of the command that prints them: they carry the flags that it was given."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from .at_once.complete import SHARED, plain
from .commands import files

NOWHERE = frozenset({"completion", "help", "init", "login", "serve", "token"})
"""Commands that ask neither a bench nor the folder of a lab."""
FILES = frozenset({
    "bench use", "catalog list", "catalog new", "catalog page", "catalog show", "check", "data", "doctor", "fmt",
    "git branch", "git install", "git tag", "git uninstall", "pull", "push", "remote", "test",
})  # fmt: skip
"""Commands that read a lab's folder, whichever bench is meant."""
OPTIONS = {"folder": "-C", "backend": "--backend", "emulate": "--emulate", "at": "--bench"}
"""The options that say which bench is meant, by the names under which a session remembers them."""
_BENCH = ("--backend", "--emulate", "--bench")
_COMMAND = re.compile(r"`pico(?=\s)([^`]*)`")
_DIAGNOSTIC = {"severity", "code", "summary"}
_HINTS = ("hint", "advice")


def flags_of(said: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the flags that reach a bench again, each as it is typed: `-C lab`, `--backend hardware`, `--emulate`.

    `said`: the values of OPTIONS that were given.
    """
    given = [(option, said[name]) for name, option in OPTIONS.items() if said.get(name)]
    return tuple(option if value is True else f"{option} {shlex.quote(str(value))}" for option, value in given)


def with_flags(text: str, flags: Sequence[str]) -> str:
    """Return a text whose commands between backticks (`pico apply e1`) carry `flags`, as far as each needs them and has
    no own ones."""
    if not flags or "`pico" not in text:
        return text
    return _COMMAND.sub(lambda found: _flagged(found[1], flags), text)


def with_flags_in(data: Any, flags: Sequence[str]) -> Any:
    """Return data to be printed as JSON with the flags in the commands of its diagnostics and hints; all else is data
    of the lab, and stays."""
    if not flags:
        return data
    if isinstance(data, Mapping):
        whole = data.keys() >= _DIAGNOSTIC
        return {
            key: with_flags(value, flags)
            if isinstance(value, str) and (whole or key in _HINTS)
            else with_flags_in(value, flags)
            for key, value in data.items()
        }
    if isinstance(data, list | tuple):
        return [with_flags_in(one, flags) for one in data]
    return data


def _flagged(rest: str, flags: Iterable[str]) -> str:
    """Return a command between backticks, of which `rest` follows the word `pico`."""
    words = _words(rest)
    names = plain(words, SHARED)
    if "--help" in words or not names or names[0] in NOWHERE or names[0] not in files():
        return f"`pico{rest}`"
    lab_alone = bool({" ".join(names[:1]), " ".join(names[:2])} & FILES) and "--journal" not in words
    lab_alone = lab_alone or any(one in words for one in _BENCH)
    own = [flag for flag in flags if not _left_out(flag.partition(" ")[0], words, lab_alone)]
    return f"`pico{''.join(f' {flag}' for flag in own)}{rest}`"


def _left_out(option: str, words: Sequence[str], lab_alone: bool) -> bool:
    """Return whether a command says itself what an option says, or does not depend on it."""
    return lab_alone if option in _BENCH else option in words


def _words(rest: str) -> list[str]:
    """Return the words of a command as a shell has them, one with an open quote as it stands."""
    try:
        return shlex.split(rest)
    except ValueError:
        return rest.split()
