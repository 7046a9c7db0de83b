"""Where a picture went."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def text(path: Path, *, shown: Path, what: str) -> str:
    """Return one line."""
    return f"Drew {what} to {shown} ({path.stat().st_size / 1024:.0f} KiB)."


def data(path: Path, *, what: str, **_: Any) -> dict[str, Any]:
    """Return schema `pico.render/v1`: `path`, `what`."""
    return {"schema": "pico.render/v1", "path": str(path.resolve()), "what": what}
