"""A run that is left to the bench, or to a process of its own."""

from __future__ import annotations

from typing import Any


def text(run: str, *, by: str = "at the bench") -> str:
    """Return which run it is, and how it is followed and ended."""
    return f"Run {run} goes on {by}: `pico runs attach` follows it, `pico stop` ends it."


def data(run: str, **_: Any) -> dict[str, Any]:
    """Return schema `pico.left/v1`: the `run`."""
    return {"schema": "pico.left/v1", "run": run}
