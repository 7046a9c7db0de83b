"""Conflict markers, as every editor knows them, with what each side did in their labels."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from pico.history.merge.leaves import Conflict

Side = Literal["ours", "theirs"]
_LINE = re.compile(r"[^\n]*\n|[^\n]+")
_TOKEN = re.compile(r"__pico_conflict_(\d+)__")
OPEN, MIDDLE, CLOSE = "\0<", "\0=", "\0>"


@dataclass(frozen=True, slots=True)
class Labels:
    """What the two sides and what they come from are called, and how long a marker is."""

    ours: str = "ours"
    base: str = "base"
    theirs: str = "theirs"
    size: int = 7


def token(number: int) -> str:
    """Return what stands in a text for the value that is conflict `number`, until both values are written."""
    return f"__pico_conflict_{number}__"


def has_token(text: str) -> bool:
    """Return whether a manifest holds what `token` returns, as only one that is made to do harm does."""
    return bool(_TOKEN.search(text)) or "\0" in text


def written(
    text: str, conflicts: Sequence[Conflict], values: Mapping[int, tuple[str, str]], labels: Labels, newline: str
) -> str:
    """Return a text with both values of every token, each side in its lines, and with sentinels as markers.

    `values`: by conflict, the value as ours and theirs write it.
    """
    result: list[str] = []
    block: list[str] = []
    for line in [*_LINE.findall(text), ""]:
        if _TOKEN.search(line):
            block.append(line if line.endswith(("\n", "\r")) else line + newline)
            continue
        if block:
            result += _both(block, conflicts, values, labels, newline)
            block = []
        mark = line.strip(" \r\n")
        result.append(_marker(mark, conflicts, labels) + newline if mark.startswith("\0") else line)
    return "".join(result)


def _both(
    block: list[str],
    conflicts: Sequence[Conflict],
    values: Mapping[int, tuple[str, str]],
    labels: Labels,
    newline: str,
) -> list[str]:
    numbers = [int(n) for line in block for n in _TOKEN.findall(line)]
    ours = [_TOKEN.sub(lambda m: values[int(m[1])][0], line) for line in block]
    theirs = [_TOKEN.sub(lambda m: values[int(m[1])][1], line) for line in block]
    said = [", ".join(f"{conflicts[n].address} {_side(conflicts[n], side)}" for n in numbers) for side in (0, 1)]
    return [
        f"{'<' * labels.size} {labels.ours}: {said[0]}{newline}", *ours, "=" * labels.size + newline, *theirs,
        f"{'>' * labels.size} {labels.theirs}: {said[1]}{newline}",
    ]  # fmt: skip


def _side(conflict: Conflict, side: int) -> str:
    return (conflict.ours, conflict.theirs)[side]


def _marker(mark: str, conflicts: Sequence[Conflict], labels: Labels) -> str:
    if mark.startswith(MIDDLE):
        return "=" * labels.size
    opens = mark.startswith(OPEN)
    conflict = conflicts[int(mark[2:])]
    side, sign = (labels.ours, "<") if opens else (labels.theirs, ">")
    return f"{sign * labels.size} {side}: {conflict.address} {_side(conflict, 0 if opens else 1)}"


def view(text: str, side: Side, size: int = 7) -> str:
    """Return a text as it is once every conflict in it is resolved for one side."""
    kept: list[str] = []
    inside = ""
    for line in _LINE.findall(text):
        bare = line.rstrip("\r\n")
        if bare.startswith("<" * size + " "):
            inside = "ours"
        elif bare == "=" * size and inside:
            inside = "theirs"
        elif bare.startswith(">" * size + " ") and inside:
            inside = ""
        elif inside in ("", side):
            kept.append(line)
    return "".join(kept)
