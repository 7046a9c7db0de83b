"""Diagnostics as a compiler shows them: what, where, the line with a caret, what would be right."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from pico.diagnostics import Diagnostic, SourceRange

from .style import count, paint, shorten, wide, width, wrap

_COLORS = {"error": "red", "warning": "yellow", "note": "cyan"}


def text(diagnostics: Sequence[Diagnostic], *, tally: bool = True) -> str:
    """Return all of them, errors last so that they stand next to the prompt, with a tally where there are several."""
    order = sorted(diagnostics, key=lambda d: ("note", "warning", "error").index(d.severity))
    blocks = ["\n".join(_lines(d)) for d in order]
    if tally and len(order) > 1:
        blocks.append(_tally(order))
    return "\n\n".join(blocks)


def _room() -> int:
    """Return in how many columns messages are wrapped: in those of a terminal; in a pipe, where others search, not."""
    return wide(sys.stderr) if sys.stderr.isatty() else 1_000_000


def _lines(d: Diagnostic) -> list[str]:
    kind, room = f"{d.severity}[{d.code}]", _room()
    first, *rest = wrap(f"{kind}: {d.summary}", "", room)
    lines = [
        paint(_COLORS[d.severity], kind) + paint("bold", first.removeprefix(kind)),
        *(paint("bold", r) for r in rest),
    ]
    if d.source:
        lines += _snippet(d, d.source)
    lines += wrap(d.detail, "   ", room) if d.detail and d.detail != d.label else []
    if d.hint:
        first, *rest = wrap(d.hint, " " * 11, room)
        lines += [f"   = {paint('cyan', 'help')}: {first.strip()}", *rest]
    return lines


def _snippet(d: Diagnostic, source: SourceRange) -> list[str]:
    where = f"  {paint('blue', '-->')} {source}"
    if not source.snippet.strip():
        return [where] + ([f"   = {d.label}"] if d.label else [])
    gutter = len(str(source.start.line))
    bar = paint("blue", " " * gutter + " |")
    line, column = _window(source.snippet.expandtabs(1).rstrip(), source.start.column - 1)
    end = source.end.column - source.start.column if source.end.line == source.start.line else 1000
    length = max(1, min(end, len(line) - column))
    caret = paint(_COLORS[d.severity], "^" * length + (f" {d.label}" if d.label else ""))
    return (
        [
            where,
            bar,
            f"{paint('blue', str(source.start.line) + ' |')} {line}",
            f"{bar} {' ' * column}{caret}" if width(caret) + column < 110 else f"{bar} {' ' * column}{'^' * length}",
        ]
        + ([f"{bar} {d.label}"] if d.label and width(caret) + column >= 110 else [])
        + ([bar] if d.hint or d.detail not in ("", d.label) else [])
    )


def _window(line: str, column: int, room: int = 88) -> tuple[str, int]:
    """Return the stretch of a long line around `column`, and where the column is in it."""
    safe = "".join(c if c.isprintable() else "�" for c in line)
    start = max(0, column - room // 2) if len(safe) > room else 0
    return shorten(safe[start:], room), column - start


def _tally(diagnostics: Sequence[Diagnostic]) -> str:
    found = [(s, sum(d.severity == s for d in diagnostics)) for s in ("error", "warning", "note")]
    return ", ".join(count(n, s) for s, n in found if n)


def data(diagnostics: Sequence[Diagnostic]) -> dict[str, Any]:
    """Return `{"schema", "diagnostics": [{severity, code, summary, ..., source: {path, start, end, snippet}}]}`."""
    from pico.model.record import as_json

    return {"schema": "pico.diagnostics/v1", "diagnostics": as_json(diagnostics)}
