"""What an optimization would try, and how long that takes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pico.model.record import as_json

from .style import columns, seconds

if TYPE_CHECKING:
    from pico.bench.goals import Chosen
    from pico.model.lab import Setup


def text(chosen: Chosen, setup: Setup) -> str:
    """Return algorithm, bounds, what is measured, budget and time."""
    goal = chosen.goal
    aim = ", ".join(f"{n} to {t:g} within {goal.near(n):g}" for n, t in (goal.reach or {}).items())
    rows = [["algorithm", f"{chosen.algorithm}: {chosen.why}"], [goal.aim, aim or goal.texts[0]]]
    for name, (low, high) in goal.tunables.items():
        component, _, tunable = name.partition(".")
        rows.append([name, f"{low:g} to {high:g} {setup.type_of(component).tunables[tunable].unit}".rstrip()])
    budget = f"at most {goal.budget.measurements} measurements and {seconds(goal.budget.seconds)}"
    rows.append(["budget", f"{budget}; about {seconds(chosen.seconds)} expected"])
    return "\n".join(["", f"{chosen.name} would be sought so:", *(f"  {row}" for row in columns(rows))])


def data(chosen: Chosen, setup: Setup) -> dict[str, Any]:
    """Return schema `pico.goal/v1`: `name`, `goal`, `algorithm`, `why`, `seconds`."""
    return {"schema": "pico.goal/v1", "name": chosen.name, "goal": as_json(chosen.goal), "algorithm": chosen.algorithm,
            "why": chosen.why, "seconds": chosen.seconds}  # fmt: skip
