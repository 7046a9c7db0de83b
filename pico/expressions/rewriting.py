"""From an expression as it is written to what CEL is given: all numbers of one kind, also where they are an index."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

COUNT, WHOLE = "count", "whole"
"""What `size` and `int` are for CEL, whose own give integers."""
_TOKEN = re.compile(
    r"""(?P<text>[rRbB]{0,2}(?:'{3}.*?'{3}|"{3}.*?"{3}|'(?:\\.|[^'\\\n])*'|"(?:\\.|[^"\\\n])*"))"""
    r"|(?P<comment>//[^\n]*)|(?P<name>[A-Za-z_]\w*)|(?P<hex>0[xX][0-9a-fA-F]+[uU]?)"
    r"|(?P<float>\d*\.\d+(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+)|(?P<int>\d+)(?![\w.])|(?P<other>\S)",
    re.DOTALL,
)
_RENAMED = {"size": COUNT, "int": WHOLE}
WRITTEN = {name: word for word, name in _RENAMED.items()}
"""How COUNT and WHOLE are written."""


@cache
def as_doubles(text: str) -> tuple[str, list[int]]:
    """Return the source with integers as doubles, except where they are an index, and with COUNT and WHOLE; and for
    each of its characters, and its end, the place in `text` that it comes from."""
    out: list[str] = []
    places: list[int] = []
    last, tokens = 0, list(_TOKEN.finditer(text))
    for n, token in enumerate(tokens):
        after = tokens[n + 1][0] if n + 1 < len(tokens) else ""
        word = token[0]
        if token["int"] and not (n > 1 and tokens[n - 1][0] == "[" and after == "]" and _ends_value(tokens[n - 2])):
            word += ".0"
        elif after == "(":
            word = _RENAMED.get(word, word)
        gap = text[last : token.start()]
        out += [gap, word]
        places += [*range(last, token.start()), *(min(token.start() + i, token.end() - 1) for i in range(len(word)))]
        last = token.end()
    return "".join([*out, text[last:]]), [*places, *range(last, len(text) + 1)]


def hidden(source: str, places: Sequence[int], brackets: Sequence[int]) -> tuple[str, list[int]]:
    """Return a source, and its places, where CEL is not told of what kind the index in each of `brackets` is."""
    ends, open_at = dict[int, int](), list[int]()
    for token in _TOKEN.finditer(source):
        if token[0] == "[":
            open_at.append(token.start())
        elif token[0] == "]" and open_at:
            ends[open_at.pop()] = token.start()
    found, of = source, list(places)
    marks = [(at + 1, "dyn(") for at in brackets] + [(ends[at], ")") for at in brackets]
    for at, mark in sorted(marks, reverse=True):
        found = found[:at] + mark + found[at:]
        of[at:at] = [of[at]] * len(mark)
    return found, of


def _ends_value(token: re.Match[str]) -> bool:
    return bool(token["name"]) or token[0] in ("]", ")")
