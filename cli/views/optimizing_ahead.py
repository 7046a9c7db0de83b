"""What an optimization would try, and how long that takes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import columns, seconds

if TYPE_CHECKING:
    from pico.bench.goals import Chosen
    from pico.diagnostics import Diagnostic
    from pico.model.setup import Setup
    from pico.planning.sought import Sought


def text(chosen: Chosen, setup: Setup, **_: Any) -> str:
    """Return algorithm, bounds, what is measured, budget and time; of goals that come first where it is dark, too."""
    parts = [f"{chosen.name} would be sought so:"]
    if chosen.first:
        parts = [f"{chosen.name} would be sought so, the last where it has light, else after the others:"]
    for one in (*chosen.first, chosen.one):
        label = [f"{one.name}:"] if chosen.first else []
        parts += [*label, *(f"  {row}" for row in _rows(one, setup))]
    measurements = sum(one.goal.budget.measurements for one in (*chosen.first, chosen.one))
    budget = sum(one.goal.budget.seconds for one in (*chosen.first, chosen.one))
    most = f"at most {measurements} measurements and {seconds(budget)}"
    return "\n".join(["", *parts, f"  {most}; about {seconds(chosen.seconds)} expected"])


def _rows(one: Sought, setup: Setup) -> list[str]:
    goal = one.goal
    aim = ", ".join(f"{n} to {t:g} within {goal.near(n):g}" for n, t in (goal.reach or {}).items())
    rows = [["algorithm", f"{one.algorithm}: {one.why}"], [goal.aim, aim or goal.expressions[0]]]
    for name, (low, high) in goal.tunables.items():
        component, _, tunable = name.partition(".")
        rows.append([name, f"{low:g} to {high:g} {setup.type_of(component).tunables[tunable].unit}".rstrip()])
    for look, settings in (goal.looks or {}).items():
        rows.append([f"look {look}", ", ".join(f"{address} {value}" for address, value in settings.items())])
    if one.known and one.goal.aim == "maximize":
        far = ", ".join(f"{name} {one.known.reach(n):.2g}" for n, name in enumerate(goal.tunables))
        rows += [["likely within", f"{far}"], ["", "3 sigma of how parts are put down; searched there if it is dark"]]
    return columns(rows)


def data(chosen: Chosen, setup: Setup, *, cautions: Sequence[Diagnostic] = ()) -> dict[str, Any]:
    """Return schema `pico.goal/v1`: `name`, `goal`, `algorithm`, `why`, `seconds`; `first`: what is sought before it
    where it is dark, each with `name`, `goal`, `algorithm`, `why`; `diagnostics`: what it can't tell, if anything."""
    told = {"schema": "pico.goal/v1", **_told(chosen.one), "seconds": chosen.seconds}
    told |= {"diagnostics": as_json(cautions)} if cautions else {}
    return {**told, "first": [_told(one) for one in chosen.first]} if chosen.first else told


def _told(one: Sought) -> dict[str, Any]:
    return {"name": one.name, "goal": as_json(one.goal), "algorithm": one.algorithm, "why": one.why}
