"""What is wrong, where, and what would be right: collected as data, shown by a view.

Library code collects `Diagnostic`s and, where it can't go on, raises one `PicoError` that carries all of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Literal

Severity = Literal["error", "warning", "note"]


class ExitCode(IntEnum):
    """Exit codes of every command; design, section 4."""

    DONE = 0
    ERROR = 1
    CHANGES = 2
    IMPOSSIBLE = 3
    STALE = 4
    LOCKED = 5
    EXPECTATION = 6
    DENIED = 7
    INTERRUPTED = 130


@dataclass(frozen=True, slots=True)
class Position:
    """A place in a text; `line` and `column` count from 1."""

    line: int
    column: int


@dataclass(frozen=True, slots=True)
class SourceRange:
    """A stretch of a file, `end` exclusive, with the text of its first line (`snippet`) for the caret.

    Of a folder, a link or a file as a whole it is the first character, without text; shown is the path alone.
    """

    path: str
    start: Position
    end: Position
    snippet: str = ""

    def __str__(self) -> str:
        if not self.snippet and self.start == Position(1, 1):
            return self.path
        return f"{self.path}:{self.start.line}:{self.start.column}"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding.

    `code` is a stable word such as `unit`, `unknown-key`, `impossible`, `unreachable`; `summary` one sentence that
    names the thing; `label` stands beside the caret under the source; `detail` is more text; `hint` says what would
    be right; `address` is `component` or `component.tunable`.
    """

    severity: Severity
    code: str
    summary: str
    detail: str = ""
    hint: str = ""
    address: str = ""
    label: str = ""
    source: SourceRange | None = None


def read_diagnostic(data: Mapping[str, Any]) -> Diagnostic:
    """Return a finding that was written as JSON."""
    at, source = data.get("source"), None
    if at is not None:
        source = SourceRange(at["path"], Position(**at["start"]), Position(**at["end"]), at["snippet"])
    return Diagnostic(**{**data, "source": source})


def error(
    code: str,
    summary: str,
    *,
    detail: str = "",
    hint: str = "",
    address: str = "",
    label: str = "",
    source: SourceRange | None = None,
) -> Diagnostic:
    """Return a `Diagnostic` of severity `error`."""
    return Diagnostic("error", code, summary, detail, hint, address, label, source)


def warning(
    code: str, summary: str, *, detail: str = "", hint: str = "", address: str = "", source: SourceRange | None = None
) -> Diagnostic:
    """Return a `Diagnostic` of severity `warning`."""
    return Diagnostic("warning", code, summary, detail, hint, address, source=source)


class PicoError(Exception):
    """Carries every diagnostic that stopped the work, and the exit code that a command ends with; as text, for a script
    that does not catch it, what is wrong and what would be right."""

    def __init__(self, diagnostics: Diagnostic | Iterable[Diagnostic], exit_code: ExitCode = ExitCode.ERROR) -> None:
        self.diagnostics: Sequence[Diagnostic] = (
            (diagnostics,) if isinstance(diagnostics, Diagnostic) else tuple(diagnostics)
        )
        self.exit_code = exit_code
        super().__init__("; ".join(f"{d.summary} ({d.hint})" if d.hint else d.summary for d in self.diagnostics))


class RecordError(ValueError):
    """Values that do not go together in a record; `hint` says what would be right."""

    def __init__(self, summary: str, hint: str) -> None:
        super().__init__(summary)
        self.hint = hint


_AS_NEAR = 0.01
_SLOTS_ALIKE = 0.91
"""How alike a misspelt slot must be: `storage/z9` is none of its neighbours."""
_BEGUN = 3
"""So many letters of a name, typed alone, are its beginning, and no misspelling."""


def did_you_mean(word: str, known: Iterable[str], alike: float = 0.6) -> str:
    """Return a hint for a misspelt `word`: the nearest known one, at least so much `alike` (0 to 1), or the known ones
    where they are few."""
    names = sorted(known)
    likeness = {name: _likeness(word, name) for name in names}
    best = max(likeness.values(), default=0.0)
    if best >= alike:
        nearest = [f"`{name}`" for name, like in likeness.items() if like > best - _AS_NEAR][:3]
        return f"did you mean {' or '.join(nearest)}?"
    if names and len(names) <= 12:
        return "known: " + ", ".join(f"`{n}`" for n in names)
    return ""


def _likeness(word: str, name: str) -> float:
    """Return how alike two words are, 0 to 1: by the letters to be changed, added, left out or swapped with the next
    one (Damerau's distance in its restricted form), or by the runs of letters that they share, as `thru` and `through`;
    the beginning of a name is nearly the name."""
    import difflib

    if len(word) >= _BEGUN and name.startswith(word):
        return max(0.9, len(word) / len(name))
    changed = 1.0 - _changes(word, name) / max(len(word), len(name), 1)
    return max(changed, difflib.SequenceMatcher(None, name, word).ratio())


def _changes(a: str, b: str) -> int:
    """Return the fewest letters to be changed, added, left out or swapped with the next one between two words."""
    before: list[int] = []
    last = list(range(len(b) + 1))
    for i, x in enumerate(a, 1):
        row = [i]
        for j, y in enumerate(b, 1):
            least = min(last[j] + 1, row[j - 1] + 1, last[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                least = min(least, before[j - 2] + 1)
            row.append(least)
        before, last = last, row
    return last[-1]


def slot_meant(word: str, slots: Iterable[str]) -> str:
    """Return a hint for a slot that there is not, like `did_you_mean`; `a4` and `storge/a4` may be `storage/a4`."""
    known = sorted(slots)
    short = [f"`{slot}`" for slot in known if slot.rpartition("/")[2] == word.rpartition("/")[2]]
    return f"did you mean {' or '.join(short)}?" if short else did_you_mean(word, known, _SLOTS_ALIKE)
