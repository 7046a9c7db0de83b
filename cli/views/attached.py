"""Which worktree has the bench."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pico.places.bench import BenchPlace


def text(place: BenchPlace, before: Path | None) -> str:
    """Return what was done, and where the bench was until then."""
    if before is None:
        return f"The bench `{place.name}` is attached to {place.root}."
    came = f"its state and journal came from {before}, which only plans on it now"
    return f"The bench `{place.name}` is attached to {place.root}; {came}."


def data(place: BenchPlace, before: Path | None) -> dict[str, Any]:
    """Return schema `pico.attached/v1`: `bench`, `folder`, and `before`, the folder that had it, null for none."""
    return {
        "schema": "pico.attached/v1", "bench": place.name, "folder": str(place.root),
        "before": str(before) if before else None,
    }  # fmt: skip
