"""Which worktree has the bench."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def text(folder: Path, before: Path | None) -> str:
    """Return what was done, and where the bench was until then."""
    if before is None:
        return f"The bench is attached to {folder}."
    return (
        f"The bench is attached to {folder}; its simulated table and journal came from {before}, which only plans now."
    )


def data(folder: Path, before: Path | None) -> dict[str, Any]:
    """Return schema `pico.attached/v1`: `folder`, and `before`, the folder that had the bench, null for none."""
    return {"schema": "pico.attached/v1", "folder": str(folder), "before": str(before) if before else None}
