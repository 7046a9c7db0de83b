"""A film of a run: what is written under it, and where it went."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pico.model.plan import Plan

from .plan import change_of, what
from .style import plain
from .style import seconds as duration


def titles(plan: Plan) -> dict[str, str]:
    """Return the caption of each operation by its id: `5/12 p2 storage/b2 → (520, 420, 30°)`."""
    total = len(plan.operations)
    return {
        op.id: plain(f"{number}/{total}  {op.address}  {what(op, change_of(plan, op))}")
        for number, op in enumerate(plan.operations, 1)
    }


def text(path: Path, *, shown: Path, seconds: float, share: float) -> str:
    """Return one line; `share` is 1 where the film is whole."""
    size = f"{path.stat().st_size / 1e6:.1f} MB"
    if share < 1:
        part = f"the first {duration(share * seconds)} of {duration(seconds)}"
        return f"Filmed {part} to {shown} ({size}); the rest was interrupted."
    return f"Filmed {duration(seconds)} to {shown} ({size})."


def data(path: Path, *, seconds: float, share: float, **_: Any) -> dict[str, Any]:
    """Return schema `pico.film/v1`: `path`, `seconds` of the run, and the `share` of them that the film shows."""
    return {"schema": "pico.film/v1", "path": str(path.resolve()), "seconds": seconds, "share": share}
