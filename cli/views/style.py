"""Plain text with a little color, columns, and numbers as people write them."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Sequence
from datetime import datetime
from typing import Any, TextIO

from pico.base import clock
from pico.base.clock import Waits
from pico.model.state import is_reference, said

WIDTH = 100
_CODES = {"bold": 1, "dim": 2, "red": 31, "green": 32, "yellow": 33, "blue": 34, "cyan": 36}
_ANSI = re.compile(r"\x1b\[[0-9;]*m")
_OWN = "|".join(str(code) for code in (0, *_CODES.values()))
_UNSAFE = re.compile(
    rf"\x1b(?!\[(?:{_OWN})m)|\r(?!\n)"
    r"|[\x00-\x08\x0b\x0c\x0e-\x1a\x1c-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]"
)
"""What may steer a terminal: control characters (C0 and C1), but for tabs, line breaks and the colors of `paint`; and
the marks that turn the direction of writing."""


def paint(style: str, text: str) -> str:
    """Return `text` in a style (`bold`, `dim`, `red`, ...); `Output` removes it where no color is wanted."""
    return f"\x1b[{_CODES[style]}m{text}\x1b[0m" if text else text


def plain(text: str) -> str:
    """Return `text` without color."""
    return _ANSI.sub("", text)


def printable(text: str) -> str:
    """Return what somebody else wrote, without what would steer the terminal; line breaks stay."""
    return "".join(c if c.isprintable() or c == "\n" else "    " if c == "\t" else "?" for c in plain(text))


def inert(text: str) -> str:
    """Return `text` with what may steer a terminal written out (`\\x1b`, `\\u202e`): names, messages and notes are
    written by others. The colors of `paint` stay."""
    return _UNSAFE.sub(lambda found: ascii(found[0])[1:-1], text)


def inert_json(text: str) -> str:
    """Return a JSON document with what may steer a terminal as JSON escapes it; it says the same."""
    return _UNSAFE.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def width(text: str) -> int:
    """Return how many columns `text` takes."""
    return len(plain(text))


def pad(text: str, columns: int) -> str:
    """Return `text` with spaces to the right, `columns` wide or more."""
    return text + " " * (columns - width(text))


def columns(rows: Sequence[Sequence[str]], *, gap: int = 2, indent: str = "", last: int = 1000) -> list[str]:
    """Return rows of cells as aligned lines. The last cell is not padded; one over `last` columns is cut."""
    if not rows:
        return []
    widths = [max(width(row[i]) for row in rows if i < len(row)) for i in range(max(map(len, rows)))]
    lines = []
    for row in rows:
        cells = [pad(cell, widths[i]) for i, cell in enumerate(row[:-1])] + [shorten(row[-1], last)]
        lines.append((indent + (" " * gap).join(cells)).rstrip())
    return lines


def shorten(text: str, columns: int) -> str:
    """Return `text`, cut with an ellipsis where it is wider than `columns`: after a word, where there is one."""
    if width(text) <= columns:
        return text
    kept = plain(text)[: max(columns - 1, 0)]
    words, space, _ = kept.rpartition(" ")
    return (words.rstrip(" ,;:") if space and 2 * len(words) > columns else kept) + "…"


def wide(stream: TextIO | None = None) -> int:
    """Return how many columns text may take: WIDTH, or those of the terminal where `stream` (standard output) is one
    that has fewer."""
    import shutil

    shown = (stream or sys.stdout).isatty() or "GIT_PAGER_IN_USE" in os.environ
    return min(WIDTH, shutil.get_terminal_size((WIDTH, 24)).columns) if shown else WIDTH


def wrap(text: str, indent: str, columns: int = 0) -> list[str]:
    """Return `text` in lines of at most `columns` (as `wide` says), each after `indent`; line breaks stay."""
    import textwrap

    room = max((columns or wide()) - len(indent), 20)
    lines = [line for part in text.splitlines() for line in (textwrap.wrap(part, room) or [""])]
    return [f"{indent}{line}".rstrip() for line in lines]


def folded(text: str, columns: int) -> str:
    """Return `text` with lines wider than `columns` broken between words; what follows begins where the line began."""
    return "\n".join(part for line in text.split("\n") for part in _folded(line, columns))


def _folded(line: str, columns: int) -> list[str]:
    if width(line) <= columns:
        return [line]
    indent = " " * min(len(line) - len(line.lstrip(" ")), columns // 2)
    found = [""]
    for number, word in enumerate(line.split(" ")):
        if number and width(found[-1]) + 1 + width(word) > columns:
            found.append(indent + word)
        else:
            found[-1] += f" {word}" if number else word
    return [part.rstrip(" ") for part in found]


def count(number: int, noun: str, plural: str = "") -> str:
    """Return `1 move`, `2 moves`."""
    return f"{number} {noun if number == 1 else plural or noun + 's'}"


def listed(names: Sequence[str], limit: int = 6) -> str:
    """Return `a, b and c`, or the first few and how many more there are."""
    if len(names) > limit:
        return f"{', '.join(names[:limit])} and {len(names) - limit} more"
    return " and ".join(([", ".join(names[:-1])] if names[:-1] else []) + list(names[-1:]))


def number(value: float, digits: int = 2) -> str:
    """Return a number without needless zeros: `420`, `12.5`, `0.07`."""
    text = f"{round(value, digits) + 0.0:.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def seconds(value: float) -> str:
    """Return a duration: `0.4 s`, `41 s`, `2 min 05 s`."""
    if value < 60:
        return f"{value:.1f} s"
    return f"{int(value) // 60} min {int(value) % 60:02d} s"


def no_waits() -> Waits:
    """Return the waits of a bench whose clock is that on the wall."""
    return ()


_waits: list[Callable[[], Waits]] = [no_waits]


def count_waits(waits: Callable[[], Waits]) -> None:
    """Count ages from now on by the clock of a bench, of which `waits` returns what a simulated one was told to let
    pass."""
    _waits[:] = [waits]


def ago(moment: str, now: datetime | None = None, *, waits: Waits | None = None) -> str:
    """Return how long ago a moment (ISO 8601) was on the clock of the bench: `just now`, `40 s ago`, `3 min ago`,
    `2 h ago`, `5 d ago`. `now`: on the wall, without waits. `waits`: of another bench than the one that is open."""
    if now is not None:
        return past((now - clock.parse(moment)).total_seconds())
    return past(clock.seconds_on_bench(moment, clock.now_ms(), _waits[0]() if waits is None else waits))


def past(past: float) -> str:
    """Return `just now`, `40 s ago`, `3 min ago`, `2 h ago` or `5 d ago` for some seconds."""
    if past < 10:
        return "just now"
    size, unit = next((s, u) for s, u in ((86400, "d"), (3600, "h"), (60, "min"), (1, "s")) if past >= s)
    return f"{int(past // size)} {unit} ago"


def valued(value: Any, unit: str) -> str:
    """Return a value in its unit; a set-point that light finds says its own."""
    return said(value, unit) if is_reference(value) else f"{place(value)} {unit}".rstrip()


def place(value: Any) -> str:
    """Return a place as a change or an operation holds it: a slot's name, `(x, y, yaw°)`, or a value."""
    if value is None:
        return "unknown"
    if isinstance(value, dict) and "x" in value:
        return f"({number(value['x'])}, {number(value['y'])}, {number(value.get('yaw', 0.0))}°)"
    if is_reference(value):
        return said(value)
    if isinstance(value, dict):
        return value.get("slot") or place(value.get("pose"))
    if isinstance(value, bool):
        return "true" if value else "false"
    return number(value, 4) if isinstance(value, int | float) else str(value)


def on_bench(evidence: str, bench: str | None) -> str:
    """Return `kinematic, sim`; `emulated` and `hardware` are benches that say so themselves."""
    return evidence if bench in (None, evidence) else f"{evidence}, {printable(str(bench))}"
