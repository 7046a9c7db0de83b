"""The trailers of a commit message: the last paragraph, `Key: value` a line, as `git interpret-trailers` reads it.

What PICO writes there is an index for people and scripts; the truth is what the commit holds (`pico verify`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from pico.diagnostics import PicoError, error

Trailers = tuple[tuple[str, str], ...]
STATE, EVIDENCE, LAB = "Pico-State", "Pico-Evidence", "Pico-Lab"
RUN, PLAN, META, HAND = "Pico-Run", "Pico-Plan", "Pico-Meta", "Pico-Hand"
BENCH = "Pico-Bench"
"""The bench that stood so."""
NO_HAND = "none"
"""What HAND says where all that no run changed was written into the manifest."""
_OURS = {STATE.lower(), EVIDENCE.lower(), LAB.lower(), RUN.lower(), PLAN.lower(), HAND.lower(), BENCH.lower()}
_TRAILER = re.compile(r"([A-Za-z0-9-]+)[ \t]*:[ \t]*(.*)")
_OF_GIT = ("Signed-off-by: ", "(cherry picked from commit ")
_KEY = re.compile(r"[a-z][a-z0-9_.-]*")


def with_trailers(message: str, added: Iterable[tuple[str, str]]) -> str:
    """Return a message with one block of trailers at its end: those that it has, then those `added`, none twice.

    The user's words stay as they are. What the message says of a state, its evidence, lab, runs and plan (it may have
    been copied from another commit) gives way to what is added.
    """
    body, block = _split(message.strip("\n").rstrip())
    kept = _kept(block, _OURS)
    known = set(kept)
    new = [line for line in dict.fromkeys(f"{key}: {value}" for key, value in added) if line not in known]
    lines = [*kept, *new]
    return "\n".join([body, *(["", *lines] if lines else [])]) + "\n"


def trailers(message: str) -> Trailers:
    """Return the trailers of a message in their order; values that go on in indented lines in one line."""
    whole: list[str] = []
    for line in _split(message.rstrip())[1]:
        if whole and line[0].isspace():
            whole[-1] = f"{whole[-1]} {line.strip()}"
        else:
            whole.append(line.rstrip())
    return tuple((match[1], match[2].strip()) for match in map(_TRAILER.fullmatch, whole) if match)


def without_trailers(message: str) -> str:
    """Return a message without the trailers that PICO writes: what the author said."""
    body, block = _split(message.rstrip())
    kept = _kept(block, _OURS | {META.lower()})
    return "\n".join([body, *(["", *kept] if kept else [])])


def values(message: str, key: str) -> tuple[str, ...]:
    """Return the values of one trailer, in their order."""
    return tuple(value for name, value in trailers(message) if name.lower() == key.lower())


def meta(message: str) -> dict[str, str]:
    """Return what `--meta key=value` recorded; of a key given twice, the last."""
    pairs = (value.partition("=") for value in values(message, META))
    return {key: value for key, sign, value in pairs if sign and _KEY.fullmatch(key)}


def require_message(message: str) -> None:
    """Raise PicoError for a message without a word: its trailers would become the subject."""
    if not without_trailers(message).strip():
        hint = 'say why: `pico commit -m "why"`; without -m the message says what changed'
        raise PicoError(error("message", "the message is empty: nothing was committed", hint=hint))


def require_meta(given: Mapping[str, str]) -> None:
    """Raise PicoError for keys and values that can't be recorded: all of them at once."""
    found = [
        error("meta", f"`{key}` is no key for --meta", hint="letters a to z, digits, `_`, `.` and `-`, a letter first")
        for key in given
        if not _KEY.fullmatch(key)
    ]
    found += [
        error("meta", f"the value of `{key}` is {what}", hint="one line of text: `--meta temperature='21.3 degC'`")
        for key, value in given.items()
        if (what := _unfit(value))
    ]
    if found:
        raise PicoError(found)


def _unfit(value: str) -> str:
    if not value.strip():
        return "empty"
    return "more than one line" if not value.isprintable() else ""


def _split(message: str) -> tuple[str, list[str]]:
    """Return a message without its block of trailers, and the lines of that; the first paragraph is never one."""
    lines = message.split("\n")
    start = next((i + 1 for i in range(len(lines) - 1, 0, -1) if not lines[i].strip()), None)
    title = next((i for i, line in enumerate(lines) if line.strip()), 0)
    ended = next((i for i in range(title, len(lines)) if not lines[i].strip()), len(lines))
    if start is None or start <= ended or not _is_block(lines[start:]):
        return message, []
    return "\n".join(lines[:start]).rstrip(), lines[start:]


def _is_block(lines: list[str]) -> bool:
    """Whether lines are trailers for git: all of them, or a quarter where one is of the kind that git itself writes."""
    of_git = trailing = other = 0
    after = False  # whether an indented line goes on a trailer
    for line in lines:
        if line.startswith(_OF_GIT):
            of_git, trailing, after = of_git + 1, trailing + 1, True
        elif line[:1].isspace():
            other += not after
        elif _TRAILER.fullmatch(line):
            trailing, after = trailing + 1, True
        else:
            other, after = other + 1, False
    return bool(trailing) and (not other or (of_git > 0 and trailing * 3 >= other))


def _kept(block: list[str], dropped: set[str]) -> list[str]:
    """Return a block without some trailers and the indented lines that go on them."""
    kept: list[str] = []
    dropping = False
    for line in block:
        if not line[:1].isspace():
            match = _TRAILER.fullmatch(line)
            dropping = match is not None and match[1].lower() in dropped
        if not dropping:
            kept.append(line)
    return kept
