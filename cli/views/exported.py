"""Runs that were written to a file of another format."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .style import listed

SCHEMA = "pico.exported/v1"


def text(runs: Sequence[str], form: str, out: Path) -> str:
    """Return what was written where."""
    what = "measurements" if form == "csv" else "documents"
    if len(runs) == 1:
        return f"run {runs[0]}: its {what} are in {out}"
    return f"runs {listed(runs)}: their {what} are in {out}"


def data(runs: Sequence[str], form: str, out: Path) -> dict[str, Any]:
    """Return the same as JSON: `pico.exported/v1`."""
    return {"schema": SCHEMA, **_named(runs), "as": form, "out": str(out)}


def rows(runs: Sequence[str], table: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return measurements as JSON, a row each."""
    return {"schema": SCHEMA, **_named(runs), "as": "csv", "rows": list(table)}


def _named(runs: Sequence[str]) -> dict[str, Any]:
    return {"run": runs[0]} if len(runs) == 1 else {"runs": list(runs)}
