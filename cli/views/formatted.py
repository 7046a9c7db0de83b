"""What `pico fmt` changed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .style import count


def text(changed: Sequence[str], *, check: bool) -> str:
    """Return the files, one a line, and a tally."""
    if not changed:
        return "Every manifest is in the normal form."
    verb = "would change" if check else "brought into the normal form"
    return "\n".join([*changed, f"{count(len(changed), 'file')} {verb}."])


def data(changed: Sequence[str], *, check: bool) -> dict[str, Any]:
    """Return schema `pico.fmt/v1`: `files`, and whether they were written."""
    return {"schema": "pico.fmt/v1", "files": list(changed), "written": not check}
