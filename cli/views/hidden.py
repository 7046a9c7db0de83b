"""What is hidden in the simulated world: what befell parts that no camera over the bench sees."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .style import columns, paint

if TYPE_CHECKING:
    from pico.model.setup import Setup

Hidden = Mapping[str, Mapping[str, float | str]]
_UNITS = {"ahead": "mm", "left": "mm", "up": "mm", "focal_length": "mm", "roll": "deg", "pitch": "deg", "yaw": "deg",
          "retardance": "waves"}  # fmt: skip


def text(setup: Setup, found: Hidden) -> str:
    """Return a row for each part, and how to take it back."""
    if not found:
        return "Nothing is hidden in the simulated world: parts are as they read."
    rows = [[name, ", ".join(_said(setup, name, what, by) for what, by in own.items())] for name, own in found.items()]
    lines = [f"  {row}" for row in columns([[paint("dim", "part"), paint("dim", "hidden")], *rows])]
    return "\n".join(
        [*lines, "Take it back with `pico sim upset COMPONENT --clear`, or all with `pico sim upset --clear`."]
    )


def _said(setup: Setup, name: str, what: str, by: float | str) -> str:
    tunable = setup.type_of(name).tunables.get(what)
    if isinstance(by, str):
        return f"{what} {by}"
    if tunable is not None:
        return f"{what} slipped by {by:g} {tunable.unit}".rstrip()
    if what in ("power", "gain"):
        return f"{what} {100 * (by - 1):+.3g} %"
    return f"{what} {100 * by:.3g} %" if what == "loss" else f"{what} {by:g} {_UNITS.get(what, '')}".rstrip()


def data(setup: Setup, found: Hidden) -> dict[str, Any]:
    """Return schema `pico.hidden/v1`: `parts`, each with its changes by the names that `pico sim upset` takes."""
    return {"schema": "pico.hidden/v1", "parts": {name: dict(by) for name, by in found.items()}}
