"""The steps that recipes may have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .style import columns, paint

if TYPE_CHECKING:
    from pico.recipes.registry import Kind

LANGUAGE = {
    "scan": "tunables are set to each value, measurables `read` there: scan: {p1.angle: {from: 1, to: 5, count: 9}}",
    "foreach": "steps for each value of a list, or each combination: foreach: {tilt: [0, 15, 30]}",
    "if": "steps where something holds, `else` others: if: cam.power > 200",
    "while": "steps while something holds, at most `most` times: while: cam.power < 200",
    "let": "names get values: let: {half: (a.y - b.y) / 2}",
    "assert": "what must hold, with a `message`: assert: spot.x < 5",
    "call": "another recipe, told `with` what, known `as` what: call: null_scan",
}


def text(kinds: Mapping[str, Kind]) -> str:
    """Return a line for each step, with an example."""
    rows = [[paint("bold", name), kind.what, paint("cyan", kind.example)] for name, kind in kinds.items()]
    own = [[paint("bold", name), *said.split(": ", 1)] for name, said in LANGUAGE.items()]
    return "\n".join([*columns(rows), "", *columns(own), "", "beside each: `as`, `name`, `retries`"])


def data(kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """Return schema `pico.recipe_steps/v1`: `steps` by name with `what`, `example`, `keys`."""
    steps = {n: {"what": k.what, "example": k.example, "keys": dict(k.keys)} for n, k in kinds.items()}
    return {"schema": "pico.recipe_steps/v1", "steps": steps}
