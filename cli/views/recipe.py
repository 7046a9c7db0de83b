"""A recipe before it is run, and what became of its run."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import count, paint, seconds, shorten, wide, wrap

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pico.recipes.ahead import Foreseen
    from pico.recipes.recipe import Recipe
    from pico.recipes.running import Outcome
    from pico.recipes.walking import Entered


MOST_ITEMS = 6
"""So many items of a list are printed while a recipe runs."""
MOST_RUNS = 6
"""So many of its runs are named after a recipe."""
_TURN = re.compile(r"\[\d+\]")
"""In the path of a step: which turn of a loop."""


def text(recipe: Recipe, ahead: Foreseen) -> str:
    """Return the steps as far as they are known, with what each takes; of loops what one turn does."""
    lines, shown = [head(recipe, ahead), *_alone(recipe), ""], set[object]()
    for entered, takes in ahead.steps:
        if (place := (_TURN.sub("[]", entered.path), entered.turn)) in shown:
            continue
        shown.add(place)
        took = f"  {seconds(takes)}" if takes else "" if entered.known else "  depends on a measurement"
        lines.append(shorten(line(entered), wide() - len(took)) + paint("dim", took))
    return "\n".join(lines)


def _alone(recipe: Recipe) -> list[str]:
    """Return what a recipe states of runs where nobody is there, in a line; none where it states nothing."""
    if (stated := recipe.unattended) is None:
        return []
    stops = "; ".join(stop.text for stop in stated.stops) or "nothing"
    hours = f"{stated.begins:%H:%M} to {stated.ends:%H:%M}"
    ends = ", ".join(stated.end) or "as it is"
    text = f"Unattended: {hours}, lasers up to class {stated.laser_class}; stops for: {stops}; leaves the bench {ends}"
    return wrap(text, "")


def line(entered: Entered) -> str:
    """Return a step in a line: its path, what it does, in which turn of a loop with which values."""
    from pico.recipes.recipe import Each, Let, Scan

    title, values = entered.said, dict(entered.values)
    if entered.turn and isinstance(entered.step, Each | Scan):
        title = "foreach" if isinstance(entered.step, Each) else "scan"
    elif isinstance(entered.step, Let) and entered.known:
        title = f"let {_listed(values)}" if values else title
        values = {}
    after = ""
    if (holds := values.pop("holds", None)) is not None:
        after = _listed(values) + (": " if values else "") + ("yes" if holds else "no")
    elif entered.turn:
        total = f"/{entered.turn[1]}" if entered.turn[1] else ""
        after = f"{_listed(values)}  ({entered.turn[0]}{total})".strip()
    return f"{'  ' * (entered.depth + 1)}{paint('dim', entered.path)} {title}" + (
        paint("cyan", f"  {after}") if after else ""
    )


def _listed(values: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} = {_short(value, MOST_ITEMS)}" for name, value in values.items())


def head(recipe: Recipe, ahead: Foreseen) -> str:
    """Return what a recipe is, how many of its steps are known in advance, and how long they take."""
    from pico.recipes.recipe import Act, Scan

    known = sum(takes is not None for _, takes in ahead.steps)
    open_ = sum(not e.known and isinstance(e.step, Act | Scan) for e, _ in ahead.steps)
    title = f": {recipe.title}" if recipe.title else ""
    depending = f"{count(open_, 'step')} more depend{'s' if open_ == 1 else ''} on a measurement"
    more = "" if ahead.whole else f"; {depending if open_ else 'more may follow'}"
    said = f"{recipe.name}{title} · {count(known, 'step')} foreseen, about {seconds(ahead.seconds)} on the bench{more}"
    return "\n".join(wrap(said, ""))


def _short(value: Any, most: int | None = None) -> str:
    """Return a value as it is printed, of a list at most so many items."""
    if isinstance(value, list | tuple):
        items = [_short(one) for one in value]
        if most and len(items) > most:
            items = [*items[: most - 2], "...", items[-1]]
        return f"[{', '.join(items)}]"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def data(recipe: Recipe, ahead: Foreseen) -> dict[str, Any]:
    """Return schema `pico.recipe_ahead/v1`: `recipe`, `digest`, `seconds`, `whole`, `steps` with `path`, `title`,
    `known` (it does not depend on a measurement), `seconds`, and `diagnostics`."""
    steps = [
        {"path": e.path, "title": e.said, "known": e.known, **({"seconds": takes} if takes is not None else {})}
        for e, takes in ahead.steps
    ]
    return {
        "schema": "pico.recipe_ahead/v1", "recipe": recipe.name, "digest": recipe.digest, "seconds": ahead.seconds,
        "whole": ahead.whole, "steps": steps, "diagnostics": as_json(ahead.diagnostics),
    }  # fmt: skip


def outcome(found: Outcome, recipe: Recipe) -> str:
    """Return how a run of a recipe ended, what it returns, and what to do next."""
    colour = {"done": "green", "failed": "red"}.get(found.outcome, "yellow")
    at = f" at step {found.at}" if found.at else ""
    before = f", {found.before} of them before it was taken up" if found.before else ""
    lines = [
        f"\n{recipe.name}: {paint(colour, found.outcome)}{at}, {count(found.acted + found.before, 'step')}{before}"
    ]
    lines += [f"  {name} = {_short(value)}" for name, value in found.returns.items()]
    if found.left:
        lines.append(f"The bench is left {', '.join(found.left)}.")
    if found.outcome == "interrupted":
        lines.append("Go on with `pico run --resume`.")
    if len(found.runs) == 1:
        lines.append(f"`pico runs show {found.runs[0]}` has what it did.")
    elif found.runs:
        named = found.runs if len(found.runs) <= MOST_RUNS else (*found.runs[: MOST_RUNS - 2], "...", found.runs[-1])
        text = f"`pico runs show RUN` has what it did, in {len(found.runs)} runs one after another: {', '.join(named)}"
        lines += wrap(text, "")
    return "\n".join(lines)


def outcome_data(found: Outcome, recipe: Recipe) -> dict[str, Any]:
    """Return schema `pico.recipe_run/v1`: `run`, `recipe`, `outcome`, `at`, `returns`, `acted`, `before`, `runs` (on
    the bench), `left` (how the bench is left where nobody was there), `diagnostics`."""
    return {
        "schema": "pico.recipe_run/v1", "run": found.id, "recipe": recipe.name, "digest": recipe.digest,
        "outcome": found.outcome, "at": found.at, "returns": dict(found.returns), "acted": found.acted,
        "before": found.before, "runs": list(found.runs), "left": list(found.left),
        "diagnostics": as_json(found.diagnostics),
    }  # fmt: skip
