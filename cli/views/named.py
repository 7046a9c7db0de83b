"""A branch or a tag that was made."""

from __future__ import annotations

from typing import Any


def text(what: str, name: str, commit: str) -> str:
    """Return what was made, and where."""
    return f"The {what} {name} is at {commit[:9]}."


def data(what: str, name: str, commit: str) -> dict[str, Any]:
    """Return schema `pico.named/v1`: `what` (`branch` or `tag`), its `name`, and the `commit`."""
    return {"schema": "pico.named/v1", "what": what, "name": name, "commit": commit}
