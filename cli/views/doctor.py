"""The verdict of `pico doctor`; the findings themselves are diagnostics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.diagnostics import Diagnostic

from . import diagnostics
from .style import count


def text(found: Sequence[Diagnostic]) -> str:
    """Return one line."""
    if found:
        return f"{count(len(found), 'thing')} to look at."
    return "All is well: git knows the drivers of merge and diff, they start, the manifests are valid."


def data(found: Sequence[Diagnostic]) -> dict[str, Any]:
    """Return schema `pico.doctor/v1`: `well` and the diagnostics."""
    return {"schema": "pico.doctor/v1", "well": not found, "diagnostics": diagnostics.data(found)["diagnostics"]}
