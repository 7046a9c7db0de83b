"""Where in a file the characters of a scalar's value stand: folded, indented and escaped as they are there."""

from __future__ import annotations

from pico.diagnostics import SourceRange
from pico.manifest.text.source import Source
from pico.manifest.text.tree import Scalar

_WIDE = {"x": 4, "u": 6, "U": 10}
_BREAKS = " \t\r\n"


def inside(source: Source, node: Scalar, start: int, end: int) -> SourceRange:
    """Return where the characters [start, end) of a scalar's value stand; of its end its last one."""
    places, last = places_of(source.content, node), max(0, len(node.text.rstrip()) - 1)
    first = min(start, last)
    return source.range(places[first], places[max(first, min(end - 1, last))] + 1)


def places_of(content: str, node: Scalar) -> list[int]:
    """Return for each character of a scalar's value, and its end, the place in the text that it comes from; that of the
    scalar itself where that can't be told."""
    at, end = node.start, node.end
    if node.style in ("|", ">"):
        at = content.find("\n", at, end) + 1
    elif node.style:
        at, end = at + 1, end - 1
    found: list[int] = []
    for char in node.text:
        at = _next(content, node.style, at, end, char)
        if at >= end:
            return [node.start] * (len(node.text) + 1)
        found.append(at)
        at += _width(content, node.style, at)
        if char == " " and content[found[-1]] in "\r\n":  # a break that is folded, with the indentation after it
            while at < end and content[at] in _BREAKS:
                at += 1
    return [*found, at]


def _next(content: str, style: str, at: int, end: int, char: str) -> int:
    """Return where a character stands, `end` where it is not there: what is folded or indented is passed over."""
    while at < end and content[at] != char:
        escaped = style == '"' and content[at] == "\\"
        if escaped and content[at + 1] not in "\r\n":
            return at
        if char == " " and content[at] in "\r\n":
            return at
        if content[at] not in _BREAKS and not escaped:
            return end
        at += 1
    return at


def _width(content: str, style: str, at: int) -> int:
    if style == "'":
        return 2 if content[at : at + 2] == "''" else 1
    if style == '"' and content[at] == "\\":
        return _WIDE.get(content[at + 1], 2)
    return 1
