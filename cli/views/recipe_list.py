"""The recipes of a lab, and runs of recipes that were cut short."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .style import columns, paint

if TYPE_CHECKING:
    from pico.recipes.log import About
    from pico.recipes.recipe import Parameter
    from pico.recipes.recipes import Listed


def text(recipes: Sequence[Listed], cut_short: Sequence[About]) -> str:
    """Return a line for each recipe, and one for each run that can go on."""
    rows = [[r.name, r.title or "", paint("red", "has mistakes") if r.wrong else r.parameters] for r in recipes]
    lines = columns(rows) if rows else ["no recipes here: files of `recipes/` that say `kind: Recipe`"]
    lines += [f"{about.name} was cut short, run {about.id}: `pico run --resume` goes on" for about in cut_short]
    return "\n".join(lines)


def data(recipes: Sequence[Listed], cut_short: Sequence[About]) -> dict[str, Any]:
    """Return schema `pico.recipes/v1`: `recipes` with `name`, `title`, `parameters`, `wrong`, `inputs` (each parameter
    by `name`, `kind`, `unit`, `default`, `low`, `high`, `choices`, `description`) the steps that wait for a person
    (`asks`), and those of them that want the keys of a terminal (`steered`); `cut_short` runs."""
    return {
        "schema": "pico.recipes/v1", "recipes": [{**vars(r), "inputs": [_input(p) for p in r.inputs]} for r in recipes],
        "cut_short": [{"run": a.id, "recipe": a.name, "at": a.at} for a in cut_short],
    }  # fmt: skip


def _input(one: Parameter) -> dict[str, Any]:
    return {name: value for name, value in vars(one).items() if name != "source"}
