"""A run that is left to the bench."""

from __future__ import annotations

from typing import Any


def text(run: str) -> str:
    """Return which run it is, and how it is followed and ended."""
    return f"Run {run} goes on at the bench: `pico runs attach` follows it, `pico stop` ends it."


def data(run: str) -> dict[str, Any]:
    """Return schema `pico.left/v1`: the `run`."""
    return {"schema": "pico.left/v1", "run": run}
