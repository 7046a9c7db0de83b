"""Recipes as text, read against the bench of the case study, and walked with somebody who answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pico.diagnostics import PicoError, error
from pico.manifest.load import load_folder
from pico.manifest.text.source import Source
from pico.recipes.reader import Able
from pico.recipes.reading import read_recipe
from pico.recipes.recipe import Recipe
from pico.recipes.walking import Ask, walk

HEAD = "apiVersion: pico/v1\nkind: Recipe\nmetadata: {name: a}\n"
REVISIONS = ("C3", "e1", "main")
SHEL = load_folder(Path(__file__).parents[2] / "labs" / "shel").require()[0]


def read(text: str, others: Mapping[str, str] | None = None) -> tuple[Recipe | None, list[str]]:
    """Return a recipe, and what is wrong with it: `line: code: summary`."""

    def fetch(name: str, _: str) -> tuple[str, bytes]:
        if name not in (others or {}):
            raise PicoError(error("no-recipe", f"there is no recipe `{name}`"))
        return name, (HEAD + (others or {})[name]).encode()

    able = Able(revision=lambda name: name in REVISIONS)
    recipe, found = read_recipe(Source("a.yaml", HEAD + text), SHEL, fetch, able)
    return recipe, [f"{d.source.start.line - 3 if d.source else '-'}: {d.code}: {d.summary}" for d in found]


def right(text: str, others: Mapping[str, str] | None = None) -> Recipe:
    recipe, found = read(text, others)
    assert not found and recipe is not None, found
    return recipe


def asked(
    recipe: Recipe, answer: Callable[[Ask], Mapping[str, Any]] = lambda _: {}, **arguments: Any
) -> tuple[list[tuple[str, Any]], Any]:
    """Walk a recipe to its end; return what was asked for, and what it returns or the error that ended it."""
    given = {p.name: arguments.get(p.name, p.default) for p in recipe.parameters.values()}
    steps, asks, told = walk(recipe, given), list[tuple[str, Any]](), None
    try:
        ask = next(steps)
        while True:
            asks.append((ask.path, dict(ask.given) if ask.step else ask.names))
            try:
                told = answer(ask)
            except PicoError as exc:
                ask = steps.throw(exc)
            else:
                ask = steps.send(told)
    except StopIteration as stop:
        return asks, stop.value
    except PicoError as exc:
        return asks, exc
