"""What `pico calibrate markers` wrote."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pico.vision.sheets import Label


def text(path: Path, *, shown: Path, labels: Sequence[Label], paper: str) -> str:
    """Return two lines."""
    many = f"{len(labels)} marker{'' if len(labels) == 1 else 's'}"
    return f"Wrote {many} and the calibration board to {shown} ({paper}).\nPrint at 100 % and measure the bar: 100 mm."


def data(path: Path, *, labels: Sequence[Label], paper: str, **_: Any) -> dict[str, Any]:
    """Return schema `pico.markers/v1`: `path`, `paper`, `markers` with `number`, `size` [mm], `name`."""
    found = [{"number": label.number, "size": label.size, "name": label.name} for label in labels]
    return {"schema": "pico.markers/v1", "path": str(path.resolve()), "paper": paper, "markers": found}
