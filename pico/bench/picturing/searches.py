"""How an optimization went, from what its run kept of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.model.goal import Goal
from pico.model.setup import Setup
from pico.optimize.problem import Problem

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pico.drawing.picture import Image

OBJECTIVE = "objective"


@dataclass(frozen=True, eq=False)
class Search:
    """What was tried for a `goal`, a row of `points` a measurement, with `columns`: the time [s], tunables, outputs and
    `<output>_sigma`; NaN where it was dark. `about`: what the journal holds beside it (`met`, `why`, ...)."""

    name: str
    goal: Goal
    columns: tuple[str, ...]
    points: NDArray[np.float64]
    units: Mapping[str, str]
    about: Mapping[str, Any]

    @property
    def problem(self) -> Problem:
        """What was asked of the algorithm, as far as a result is judged by it."""
        goal, outputs = self.goal, tuple(self.goal.reach or (OBJECTIVE,))
        near = {name: goal.near(name) for name in outputs}
        return Problem((), outputs, goal.aim, dict(goal.reach or {}), near)

    def data(self, wide: int = 0) -> dict[str, Any]:
        """Return schema `pico.search/v1`: see docs/reference/json.md."""
        problem, rows, best = self.problem, list[dict[str, Any]](), None
        better = max if problem.aim == "maximize" else min
        for row in self.points.tolist():
            result = {n: v for n, v in zip(self.columns, row, strict=True) if math.isfinite(v)}
            one = problem.objective(result)
            if one is not None:
                best = one["value"] if best is None else better(best, one["value"])
            rows.append({"values": result, "merit": one and one["value"], "sigma": one and one["sigma"], "best": best})
        reach = self.goal.reach or {}
        outputs = [
            {"name": n, "unit": self.units.get(n, ""), "target": reach.get(n), "tolerance": self.goal.near(n) or None}
            for n in problem.outputs
        ]
        tunables = [
            {"name": n, "unit": self.units.get(n, ""), "range": list(bounds)}
            for n, bounds in self.goal.tunables.items()
        ]
        told = {key: self.about[key] for key in ("algorithm", "met", "why", "measurements") if key in self.about}
        merit = (self.goal.minimize or self.goal.maximize) if problem.aim != "reach" else "from the goal, in tolerances"
        return {
            "schema": "pico.search/v1", "goal": self.name, **told, "aim": problem.aim, "merit": merit,
            "enough": 1.0 if problem.aim == "reach" and all(problem.tolerance.values()) else None,
            "outputs": outputs, "tunables": tunables, "rows": rows,
        }  # fmt: skip

    def picture(self) -> Image:
        """Return its plot (height, width, 3), sRGB."""
        from pico.drawing.plots.search import search_plot

        reach = self.goal.reach or {}
        names = [c for c in self.columns if c != "time" and not c.endswith("_sigma")]
        outputs = {n: reach.get(n) if self.goal.near(n) else None for n in names if n not in self.goal.tunables}
        title = f"{self.name}: {self.about.get('algorithm', '')}"
        return search_plot(title, self.columns, self.points, outputs, self.units)


def search_of(setup: Setup, name: str, goal: Goal, about: Mapping[str, Any], points: NDArray[np.float64]) -> Search:
    """Return a search for a goal, by what the journal holds `about` it and what was tried; raises PicoError where the
    two are not of one another."""
    columns = tuple(map(str, about.get("columns") or ()))
    if points.ndim != 2 or points.shape[1] != len(columns):
        raise PicoError(error("run-file", f"what was tried for {name} has not the columns that its run tells"))
    return Search(name, goal, columns, points, _units(setup, goal), about)


def _units(setup: Setup, goal: Goal) -> dict[str, str]:
    """Return the units of what a goal sets and reaches, by name, of parts that are on the bench now."""
    found = dict[str, str]()
    for address in goal.tunables:
        component, _, tunable = address.partition(".")
        kind = setup.type_of(component).tunables.get(tunable) if component in setup.lab.inventory else None
        found[address] = kind.unit if kind else ""
    for output in goal.reach or ():
        component, measurable, number = (*goal.plain(output).split("."), "", "")[:3]
        try:
            found[output] = _unit(setup, component, measurable, number)
        except PicoError:
            found[output] = ""
    return found


def _unit(setup: Setup, component: str, measurable: str, number: str) -> str:
    from pico.kernels.pipeline import parsed

    known = setup.measurable_of(component, measurable)
    units = parsed(known.kernel).last.units if known.kernel else {}
    return units.get(number, known.unit) if number else known.unit
