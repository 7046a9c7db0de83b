"""The text of a manifest, and where in it something stands."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property

from pico.diagnostics import Position, SourceRange

_BREAK = re.compile(r"\r\n|\n|\r")
_UNPRINTABLE = re.compile(r"[^\x20-\x7e\xa0-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]")
_LONGEST_SNIPPET = 200


@dataclass(eq=False)
class Source:
    """A file's path, as diagnostics show it, and its decoded text without byte order mark."""

    path: str
    content: str = field(repr=False)

    @cached_property
    def _starts(self) -> list[int]:
        return [0, *(m.end() for m in _BREAK.finditer(self.content))]

    def position(self, index: int) -> Position:
        """Return the line and column of the character at `index`."""
        line = bisect_right(self._starts, index)
        return Position(line, index - self._starts[line - 1] + 1)

    def line(self, number: int) -> str:
        """Return line `number` (from 1) without its break, safe to show; empty where it is too long to be shown."""
        end = self._starts[number] if number < len(self._starts) else len(self.content)
        text = self.content[self._starts[number - 1] : end].rstrip("\r\n")
        return _UNPRINTABLE.sub(" ", text) if len(text) <= _LONGEST_SNIPPET else ""

    def range(self, start: int, end: int | None = None) -> SourceRange:
        """Return the stretch [start, end) of characters, at least one long and cut at the end of its first line."""
        first = self.position(start)
        stop = max(start + 1, end if end is not None else start + 1)
        line_end = self._starts[first.line] if first.line < len(self._starts) else len(self.content) + 1
        broken = self.content[start : min(stop, line_end)].rstrip(" \r\n")
        snippet = self.line(first.line)
        width = max(1, len(broken)) if snippet else 1
        return SourceRange(self.path, first, Position(first.line, first.column + width), snippet)
