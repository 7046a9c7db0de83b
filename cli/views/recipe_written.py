"""A recipe that was written out of runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def text(recipe: str, path: Path | None = None) -> str:
    """Return the recipe, or what to do with its file."""
    return f"{path} is written: `pico recipe check {path}`" if path else recipe.rstrip()


def data(recipe: str, path: Path | None = None) -> dict[str, Any]:
    """Return schema `pico.recipe_written/v1`: the `text` of the recipe, and its `path` where it was written."""
    return {"schema": "pico.recipe_written/v1", "text": recipe, "path": str(path) if path else None}
