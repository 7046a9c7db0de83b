"""Where a coordinator serves, and how one gets in."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def text(url: str, folder: Path, code: str | None) -> str:
    """Return where it serves, and what to type where it knows nobody yet."""
    first = f"The coordinator serves at {url}; its books are in {folder}."
    enter = [f"Nobody is known here yet. As admin: `pico login {url} --code {code}`, within 2 days."] if code else []
    return "\n".join([first, *enter, "Ctrl-C ends it."])


def data(url: str, folder: Path, code: str | None) -> dict[str, Any]:
    """Return schema `pico.serving/v1`: `url`, `folder`, and `code` to log in with as the first admin, else null."""
    return {"schema": "pico.serving/v1", "url": url, "folder": str(folder), "code": code}
