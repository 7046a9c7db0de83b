"""A run of a recipe told again from its log: nothing is done, and what it returned comes out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pico.diagnostics import PicoError, error
from pico.recipes.log import Log, Logged
from pico.recipes.recipe import Recipe
from pico.recipes.walking import Ask, walk


@dataclass(frozen=True)
class Retold:
    """What a run of a recipe returned, None where it came to no end; and its acts in order, each with its log."""

    returns: Mapping[str, Any] | None
    acts: tuple[tuple[Ask, Logged], ...]
    failed: str = ""


def retold(recipe: Recipe, log: Log) -> Retold:
    """Tell a run of `recipe` again, as far as its log goes."""
    steps, acts = walk(recipe, log.about.arguments), list[tuple[Ask, Logged]]()
    try:
        ask = next(steps)
        while True:
            known = log.steps.get(ask.path)
            if known is None or known.told is None:
                steps.close()
                return Retold(None, tuple(acts), f"it came to no end, at step {ask.path}")
            if ask.step is not None:
                acts.append((ask, known))
            ask = steps.send(known.told)
    except StopIteration as stop:
        return Retold(dict(stop.value), tuple(acts))
    except PicoError as exc:  # an assertion that did not hold then, either
        return Retold(None, tuple(acts), exc.diagnostics[0].summary)


def require_returned(found: Retold, name: str, run: str) -> Mapping[str, Any]:
    """Return what a run returned; raises PicoError where it came to no end."""
    if found.returns is None:
        text = f"run {run} of {name} returned nothing: {found.failed}"
        hint = "wait where it is under way; `pico run --resume` goes on with what was cut short"
        raise PicoError(error("recipe-unended", text, hint=hint))
    return found.returns
