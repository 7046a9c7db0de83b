"""Markdown of what others wrote: nothing in it links, mentions, embeds or breaks a table, at GitHub or GitLab."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from .style import plain, shorten

LONGEST = 300
_SIGIL = re.compile(r"[@#!%$&^~](?=\w)|:(?=//)|\bwww(?=\.)|\b(?:mailto|xmpp)(?=:)", re.IGNORECASE)
"""What begins a mention, a reference or a link, cut behind it; `https:` and `//` apart are none to GitHub's parser."""
_ENTITY, _MARK = re.compile(r"[&<>|\"]"), re.compile(r"[\\`*\[\]~]|(?<![^\W_])_|_(?![^\W_])")


def prose(text: str, longest: int = LONGEST) -> str:
    """Return text in one line that reads as written; a zero-width space keeps `@name` and `#1` from being links."""
    line = shorten(" ".join(visible(text).split()), longest)
    line = _SIGIL.sub("\\g<0>\u200b", line)
    line = _ENTITY.sub(lambda found: f"&#{ord(found[0])};", line)
    return _MARK.sub(r"\\\g<0>", line)


def fenced(text: str) -> str:
    """Return text as a block of code, behind a fence that is not in it."""
    body = "\n".join(visible(line).rstrip() for line in plain(text).split("\n"))
    fence = "`" * max(3, 1 + max((len(run) for run in re.findall("`+", body)), default=0))
    return f"{fence}text\n{body}\n{fence}"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Return the lines of a table; cells are Markdown already."""
    cells = [head, ["---"] * len(head), *rows]
    return [f"| {' | '.join(row)} |" for row in cells]


def visible(text: str) -> str:
    """Return text with what a screen does not show, or shows elsewhere than it stands, replaced."""
    line = plain(text)
    if line.isprintable():
        return line
    return "".join(c if c.isprintable() else " " if c.isspace() else "\ufffd" for c in line)
