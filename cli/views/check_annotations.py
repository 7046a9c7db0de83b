"""Findings as GitHub shows them beside the lines of a pull request, by commands in the output of a job."""

from __future__ import annotations

import re

from pico.bench.checking.verdict import CheckReport
from pico.diagnostics import Diagnostic

MOST = 10
"""So many of a severity GitHub shows of one step."""


def beside(checked: CheckReport) -> str:
    """Return a line for each finding that has a place in a file."""
    found = [d for lab in checked.labs for d in lab.diagnostics if d.source and d.severity != "note"]
    errors = [d for d in found if d.severity == "error"][:MOST]
    return "\n".join(_line(d) for d in (*errors, *[d for d in found if d.severity == "warning"][:MOST]))


def _line(d: Diagnostic) -> str:
    assert d.source is not None
    at = {"file": d.source.path, "line": d.source.start.line, "col": d.source.start.column, "title": f"pico: {d.code}"}
    return f"::{d.severity} {','.join(f'{k}={_value(str(v))}' for k, v in at.items())}::{_text(d.summary)}"


def _text(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _value(text: str) -> str:
    return _text(text).replace(":", "%3A").replace(",", "%2C")


def harmless(text: str) -> str:
    """Return text in which no line is a command to the runner, whatever a manifest says."""
    return re.sub(r"(?m)^(\s*)::", r"\1: :", text)
