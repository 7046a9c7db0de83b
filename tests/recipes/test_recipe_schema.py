"""The JSON Schema of recipes: current, and of one mind with the reader about steps and keys."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema
import pytest
from asking import HEAD
from generating import HELPER, MISTAKES, Maker

from pico.manifest.text.source import Source
from pico.manifest.text.tree import parse, plain
from pico.recipes.schema import path, schema, text

SCHEMA = schema()
RECIPES = sorted((Path(__file__).parents[2] / "labs").glob("*/recipes/**/*.yaml"))
SEEN = ("a step that there is not", "no step at all", "a key that there is not")
"""Mistakes that an editor sees without knowing the bench."""


def wrong(content: str) -> list[str]:
    found: Any = plain(parse(Source("x", content))[0][0].root)
    return [error.message for error in jsonschema.Draft7Validator(SCHEMA).iter_errors(found)]


def test_the_schema_of_the_repository_is_current_and_draft_07() -> None:
    assert path().read_text(encoding="utf-8") == text()
    jsonschema.Draft7Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("shipped", RECIPES, ids=lambda p: p.stem)
def test_every_recipe_that_we_ship_is_valid(shipped: Path) -> None:
    assert not wrong(shipped.read_text(encoding="utf-8"))


def test_recipes_made_at_random_are_valid() -> None:
    assert not wrong(HELPER)
    for seed in range(60):
        assert not wrong(Maker(seed).recipe()), seed


@pytest.mark.parametrize("mistake", SEEN)
def test_an_editor_sees_the_common_mistakes(mistake: str) -> None:
    assert mistake in MISTAKES and wrong(Maker(1).recipe(mistake))


@pytest.mark.parametrize(
    "steps",
    ["- {while: 1 < 2, mst: 3, steps: []}", "- {prompt: so, unatended: skip}", "- {if: 1 < 2, then: [{mesure: p1}]}",
     "- {measure: cam.power, then: []}"],
)  # fmt: skip
def test_a_key_that_stands_beside_no_such_step_is_seen(steps: str) -> None:
    assert wrong(f"{HEAD}steps:\n{steps}\n")
