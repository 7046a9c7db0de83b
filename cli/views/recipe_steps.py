"""The steps that recipes may have, and the functions of their expressions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from .style import columns, paint, wrap

if TYPE_CHECKING:
    from pico.recipes.registry import Kind


def text(kinds: Mapping[str, Kind]) -> str:
    """Return a line for each step, with an example, and what expressions may have."""
    from pico.recipes.registry import CONTROL

    rows = [[paint("bold", name), kind.what, paint("cyan", kind.example)] for name, kind in kinds.items()]
    own = [[paint("bold", name), *said.split(": ", 1)] for name, said in CONTROL.items()]
    signs = "in expressions: `+ - * /`, `< <= == != >= >`, `&& || !`, `a > 0 ? b : c`, `l[0]`, `l + [x]`, `x in l`, "
    functions = "`l.map(v, 2 * v)`, `l.filter(v, v > 0)`; " + ", ".join(_functions().values())
    beside = "beside each: `as`, `name`, `retries`"
    return "\n".join([*columns(rows), "", *columns(own), "", beside, "", *wrap(signs + functions, "")])


def _functions() -> dict[str, str]:
    from pico.expressions import CONVERSIONS, called
    from pico.recipes.scope import FUNCTIONS

    return {**called(FUNCTIONS), **CONVERSIONS}


def data(kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """Return schema `pico.recipe_steps/v1`: `steps` by name with `what`, `example`, `keys`; `functions` of
    expressions by name, each as it is called."""
    steps = {n: {"what": k.what, "example": k.example, "keys": dict(k.keys)} for n, k in kinds.items()}
    return {"schema": "pico.recipe_steps/v1", "steps": steps, "functions": _functions()}
