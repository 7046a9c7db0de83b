"""A run that was written to a file of another format."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def text(run: str, form: str, out: Path) -> str:
    """Return what was written where."""
    what = "its measurements" if form == "csv" else "its documents"
    return f"run {run}: {what} are in {out}"


def data(run: str, form: str, out: Path) -> dict[str, Any]:
    """Return the same as JSON: `pico.exported/v1`."""
    return {"schema": "pico.exported/v1", "run": run, "as": form, "out": str(out)}
