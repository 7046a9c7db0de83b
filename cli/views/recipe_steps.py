"""The steps that recipes may have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .style import columns, paint

if TYPE_CHECKING:
    from pico.recipes.registry import Kind


def text(kinds: Mapping[str, Kind]) -> str:
    """Return a line for each step, with an example."""
    from pico.recipes.registry import CONTROL

    rows = [[paint("bold", name), kind.what, paint("cyan", kind.example)] for name, kind in kinds.items()]
    own = [[paint("bold", name), *said.split(": ", 1)] for name, said in CONTROL.items()]
    return "\n".join([*columns(rows), "", *columns(own), "", "beside each: `as`, `name`, `retries`"])


def data(kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """Return schema `pico.recipe_steps/v1`: `steps` by name with `what`, `example`, `keys`."""
    steps = {n: {"what": k.what, "example": k.example, "keys": dict(k.keys)} for n, k in kinds.items()}
    return {"schema": "pico.recipe_steps/v1", "steps": steps}
