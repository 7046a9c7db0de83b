"""The figures of a recipe: what it returned, series by series."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pico.drawing.plots.curves import Curve
from pico.recipes.log import About
from pico.recipes.recipe import Figure, Recipe

from .style import columns

Drawn = Sequence[tuple[Figure, Sequence[Curve]]]


def text(recipe: Recipe, about: About, figures: Drawn) -> str:
    """Return a table for each figure, with how well it agrees with theory, and the notes of the recipe."""
    lines = [f"{recipe.title or recipe.name}, run {about.id}"]
    if not figures:
        lines.append(f"{recipe.name} declares no figures; docs/how-to/recipes.md says how.")
    for figure, curves in figures:
        lines += ["", figure.title]
        for curve in curves:
            lines += ["", f"  {curve.said}", *columns(_rows(figure, curve), indent="    ")]
    return "\n".join([*lines, *([""] if recipe.notes else []), *recipe.notes])


def _rows(figure: Figure, curve: Curve) -> list[list[str]]:
    heads = [figure.x, figure.y, *(["theory", "off"] if curve.theory else [])]
    rows = [heads]
    for n, (x, y) in enumerate(zip(curve.x, curve.y, strict=True)):
        said = f"{y:.2f} ± {curve.sigma[n]:.2f}" if curve.sigma else f"{y:.2f}"
        rows.append([f"{x:.2f}", said, *([f"{curve.theory[n]:.2f}", f"{curve.off[n]:+.2f}"] if curve.theory else [])])
    return rows


def data(recipe: Recipe, about: About, figures: Drawn) -> dict[str, Any]:
    """Return schema `pico.figures/v1`: `run`, `recipe`, `notes`, and of each figure `name`, `title`, `x`, `y` and
    `series` with their points."""
    return {
        "schema": "pico.figures/v1", "run": about.id, "recipe": recipe.name, "notes": list(recipe.notes),
        "figures": [
            {
                "name": figure.name, "title": figure.title, "x": figure.x, "y": figure.y,
                "series": [
                    {"label": c.label, "x": list(c.x), "y": list(c.y), "sigma": list(c.sigma), "theory": list(c.theory)}
                    for c in curves
                ],
            }
            for figure, curves in figures
        ],
    }  # fmt: skip
