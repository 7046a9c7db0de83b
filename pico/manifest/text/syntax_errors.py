"""What is wrong with a text that is no YAML, in words that say what to do about it."""

from __future__ import annotations

import re

import yaml

from pico.diagnostics import Diagnostic, error
from pico.manifest.text.source import Source

# What libyaml's scanner and parser say, to what it means for somebody who edits a manifest.
_MEANINGS: tuple[tuple[str, str, str], ...] = (
    (
        "mapping values are not allowed",
        "a `:` stands where no key can be",
        "check the indentation of this line and the one above, or quote a value that holds `: `",
    ),
    (
        "could not find expected ':'",
        "a key without `: `",
        "write `name: value`, a blank behind the colon, and check the indentation",
    ),
    (
        "did not find expected key",
        "this line does not fit the lines above",
        "keys of one component stand in one column; check the indentation and the quotes",
    ),
    (
        "did not find expected '-' indicator",
        "this line does not belong to the list above",
        "items of a list begin with `- ` in one column",
    ),
    (
        "did not find expected ',' or ']'",
        "a list that was opened with `[` does not end",
        'close it with `]`; separate items with commas; quote an item with `[` or `{` in it: `["l[0]"]`',
    ),
    (
        "did not find expected ',' or '}'",
        "a mapping that was opened with `{` does not end",
        'close it with `}`; separate entries with commas; quote a value with `[` or `{` in it: `{a: "l[0]"}`',
    ),
    ("found unexpected end of stream", "a quoted text does not end", "close the quote with the mark that opened it"),
    ("found unexpected document indicator", "a quoted text does not end", "close the quote"),
    ("found unknown escape character", "an unknown escape in a quoted text", "use single quotes, or double the `\\`"),
    ("block sequence entries are not allowed", "a list item stands where none can be", "begin it on a line of its own"),
    ("found a tab character", "a tab in the indentation", "indent with spaces"),
    ("found undefined tag handle", "an unknown tag", "remove the tag; quote text that begins with `!`"),
    ("found incompatible YAML document", "another YAML version", "remove the `%YAML` line; manifests are YAML 1.2"),
    ("did not find expected node content", "a value is missing", "quote text that begins with `,`, `?` or `%`"),
    (
        "did not find expected comment or line break",
        "`>` and `|` begin a block of text",
        'put the value in quotes: ">=0.2"',
    ),
    ("did not find expected <document start>", "text after the end of the document", "check the indentation"),
)

_CONFLICT = re.compile(r"^(<{7,} .*?)\r?$(?s:.*?)^={7,}\r?$(?s:.*?)^>{7,} ", re.MULTILINE)
_LEFT_OVER = re.compile(r"(?:(?:<{7}|>{7}|\|{7})(?: .*)?|={7})\s*")


def conflict(source: Source) -> Diagnostic | None:
    """Return the diagnostic of the first conflict of a merge that stands in a text, None where there is none."""
    if "<<<<<<< " not in source.content:
        return None
    found = _CONFLICT.search(source.content)
    if found is None:
        return None
    hint = "keep the values that you want without the markers, `git add` the file; `git status` says what ends it"
    return error("merge-conflict", "a merge left a conflict here", hint=hint, source=source.range(*found.span(1)))


def explain(source: Source, exc: yaml.YAMLError) -> Diagnostic:
    """Return the diagnostic of a syntax error that libyaml found in `source`."""
    mark = getattr(exc, "problem_mark", None) or getattr(exc, "context_mark", None)
    index = min(mark.index if mark else getattr(exc, "position", 0) or 0, len(source.content))
    problem = str(getattr(exc, "problem", None) or getattr(exc, "reason", None) or "not valid YAML")
    if (left := _left_over(source)) is not None:
        hint = "delete the line"
        return error("merge-conflict", "a left-over merge marker", hint=hint, source=source.range(*left))
    summary, hint = _meaning(source, index, problem)
    opened = getattr(exc, "context_mark", None)
    detail = ""
    if opened is not None and (index >= len(source.content.rstrip()) or "expected ':'" in problem):
        index = opened.index  # what never ends is shown where it begins, not at the end of the file
    elif opened is not None and mark is not None and opened.line != mark.line:
        detail = _askew(source, index) or f"it began in line {opened.line + 1}"
    return error("yaml", summary, detail=detail, hint=hint, label=problem, source=source.range(index))


def _left_over(source: Source) -> tuple[int, int] | None:
    """Return where the first line is, from its first character to its last, that only a merge writes."""
    begin = 0
    for line in source.content.splitlines(keepends=True):
        if _LEFT_OVER.fullmatch(line):
            return begin, begin + len(line.rstrip())
        begin += len(line)
    return None


def _askew(source: Source, index: int) -> str:
    """Return which line above should begin in the same column as the one at `index`; empty where one does."""
    at, beside = source.position(index), None
    column = at.column
    for number in range(at.line - 1, 0, -1):
        text = source.line(number)
        if text.strip() and not text.lstrip().startswith("#"):
            column = len(text) - len(text.lstrip(" ")) + 1
            if column <= at.column:
                break
            if beside is None or column <= beside[1]:
                beside = number, column
    if beside is None or column == at.column:
        return ""
    if column == 1:
        return f"line {beside[0]} begins in column {beside[1]}, this one in column {at.column}: one of them is askew"
    inner, outer = f"line {beside[0]} (column {beside[1]})", f"line {number} (column {column})"
    return f"it begins in column {at.column}: bring it below {outer}, or below {inner}"


def _meaning(source: Source, index: int, problem: str) -> tuple[str, str]:
    character = source.content[index : index + 1]
    if "cannot start any token" in problem:
        if character == "\t":
            return "a tab in the indentation", "indent with spaces"
        return f"the character {character} can't begin a value", "put the value in quotes"
    for said, summary, hint in _MEANINGS:
        if said in problem:
            return summary, hint
    if "\t" in source.line(source.position(index).line):
        return "not valid YAML", "indent with spaces, not tabs"
    return "not valid YAML", "check indentation, quotes and brackets here and in the line above"
