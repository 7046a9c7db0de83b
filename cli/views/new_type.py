"""A component type that was begun."""

from __future__ import annotations

from typing import Any


def text(path: str, *, name: str, line: str) -> str:
    """Return where it is, and what next."""
    return (
        f"Wrote {path}. Change what is different, `pico validate` checks it; a part of it is a line in lab.yaml:\n"
        f"  {line}"
    )


def data(path: str, *, name: str, line: str) -> dict[str, Any]:
    """Return schema `pico.new_type/v1`: `path`, `name`, the `line` of a part."""
    return {"schema": "pico.new_type/v1", "path": path, "name": name, "line": line}
