"""What a new lab holds and what to do first."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def text(folder: Path, example: str | None, *, shown: Path) -> str:
    """Return where the lab is and the first commands."""
    here = shown == Path()
    made, enter = ("this folder", []) if here else (str(shown), [f"  cd {shown}"])
    if example:
        return "\n".join([
            f"Made {made}: the example `{example}` with its history, a simulated bench with every part at home.",
            "", *enter, "  pico log --graph --oneline", "  pico status", "  pico plan",
        ])  # fmt: skip
    return "\n".join([
        f"Made {made}: the table, the arm and the inventory in lab.yaml, the state in state/.",
        "", *enter, "  pico validate", "  pico plan", "  pico catalog list     # what else there is",
    ])  # fmt: skip


def data(folder: Path, example: str | None, **_: Any) -> dict[str, Any]:
    """Return schema `pico.init/v1`: `folder`, `example`."""
    return {"schema": "pico.init/v1", "folder": str(folder.resolve()), "example": example}
