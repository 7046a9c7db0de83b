"""What is optimized, and what an algorithm is: asked for points to try (`suggest`), told what was measured (`ingest`).

That is the interface of Xopt's and blop's generators: points and results are dictionaries by name. Of a result an
output that is missing, or NaN, was not measured: it was dark there, or a frame was lost. `<output>_sigma` is its one
standard deviation, `<output>_noise_sigma` the part of that which differs between readings of one
instrument; without it, all of it does. A meter's error of scale is in the first alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol, runtime_checkable

from pico.diagnostics import PicoError, error

Aim = Literal["reach", "minimize", "maximize"]
Point = dict[str, float]
_ABSURD = 1e30
"""No instrument reads as much; squares of less can be added up."""


@dataclass(frozen=True)
class Variable:
    """A tunable by its address (`ly_150.stage_y`), with its bounds in the tunable's unit, where it stands now
    (`start`), its `period` and its `resolution`; `reach`: how far its best value is likely to be from where it
    stands, half the range between the bounds where nobody says."""

    name: str
    low: float
    high: float
    start: float
    resolution: float = 0.0
    period: float | None = None
    reach: float | None = None

    @property
    def span(self) -> float:
        """The range between the bounds."""
        return self.high - self.low

    @property
    def likely(self) -> float:
        """How far from its start its best value is likely to be."""
        return min(self.reach, self.span) if self.reach else self.span / 2

    def settable(self, value: float) -> float:
        """Return the nearest value that its axis can be set to, within the bounds."""
        if self.resolution <= 0:
            return value
        nearest = round(value / self.resolution) * self.resolution
        return min(self.high, max(self.low, round(nearest, 9)))

    def within(self, value: float) -> float:
        """Return a value brought within the bounds: by its period where that leads there, else to the nearer one."""
        if self.period and not self.low <= value <= self.high:
            turned = self.low + (value - self.low) % self.period
            if turned <= self.high:
                return turned
        return min(self.high, max(self.low, value)) if math.isfinite(value) else self.start


@dataclass(frozen=True)
class Nominal:
    """What is known of a goal before anything is measured, from where parts stand and how well they are put down; rows
    and columns are tunables, in their units.

    `shape` H: how the logarithm of a power falls around its best, ln P = c - u' H u, u from there. `spread`: the
    covariance of where the best is, around where the tunables stand. `depth`: by how much ln P may fall until it is
    dark; of a goal to be reached what is searched is all that its detector sees, and that is 1. `shift`: how far from
    where the tunables stand the middle of the spread is, none where that is empty. `slopes`: of a goal to be reached by
    how much each output changes with a unit of each tunable, a row an output; empty where the model cannot tell.
    """

    shape: tuple[tuple[float, ...], ...]
    spread: tuple[tuple[float, ...], ...]
    depth: float
    shift: tuple[float, ...] = ()
    slopes: tuple[tuple[float, ...], ...] = ()

    def reach(self, number: int) -> float:
        """Return how far from where it stands the best value of a tunable is likely to be, three standard
        deviations."""
        return 3 * math.sqrt(max(self.spread[number][number], 0.0)) + (abs(self.shift[number]) if self.shift else 0.0)


def nominal_from_json(data: Mapping[str, Any] | None) -> Nominal | None:
    """Return what a plan has of it; None for nothing."""
    if data is None:
        return None
    shape, spread, slopes = (
        tuple(tuple(map(float, row)) for row in data.get(name) or ()) for name in ("shape", "spread", "slopes")
    )
    return Nominal(shape, spread, float(data["depth"]), tuple(map(float, data.get("shift") or ())), slopes)


@dataclass(frozen=True)
class Problem:
    """Which tunables may be changed, what is measured (`outputs`), and what is wanted of it.

    `reach`: every output at its `target`, within its `tolerance`; `minimize`, `maximize`: the first output as low or as
    high as can be, `tolerance` (of that output, 0 for none) being how near to the best is near enough. `floor`: the
    least that a maximized or minimized output of a beam may be worth, below which nothing is believed (dark).
    `nominal`: what is known before anything is measured, None for nothing.
    `offset`: how far from the best, as the algorithm's model has it, its tunables are left; None: at the best measured.
    """

    variables: tuple[Variable, ...]
    outputs: tuple[str, ...]
    aim: Aim = "reach"
    target: Mapping[str, float] = field(default_factory=dict)
    tolerance: Mapping[str, float] = field(default_factory=dict)
    nominal: Nominal | None = None
    offset: Mapping[str, float] | None = None

    @property
    def start(self) -> Point:
        """Where the tunables stand."""
        return {v.name: v.start for v in self.variables}

    def within(self, point: Mapping[str, float]) -> Point:
        """Return a point brought within all bounds."""
        return {v.name: v.within(point.get(v.name, v.start)) for v in self.variables}

    def measured(self, result: Mapping[str, float]) -> bool:
        """Return whether every output of a result was measured, as a number that an instrument may give."""
        return all(abs(result.get(name, math.nan)) < _ABSURD for name in self.outputs)

    def off(self, result: Mapping[str, float]) -> dict[str, float]:
        """Return how far each output is from its target (of a goal that is to be reached)."""
        return {name: result[name] - self.target.get(name, 0.0) for name in self.outputs}

    def met(self, result: Mapping[str, float]) -> bool:
        """Return whether a result is at its target, within tolerance of every output."""
        if self.aim != "reach" or not self.measured(result):
            return False
        return all(abs(off) <= self.tolerance.get(name, 0.0) for name, off in self.off(result).items())

    def cost(self, result: Mapping[str, float]) -> float:
        """Return what is to be as low as can be: of a goal to be reached the distance from it in tolerances; infinite
        where it was not measured."""
        if not self.measured(result):
            return math.inf
        if self.aim == "reach":
            return math.hypot(*(off / (self.tolerance.get(n) or 1.0) for n, off in self.off(result).items()))
        return result[self.outputs[0]] * (1 if self.aim == "minimize" else -1)

    def objective(self, result: Mapping[str, float]) -> dict[str, Any] | None:
        """Return what is sought as a person sees it, with its `name`, `value` and one standard deviation `sigma`: how
        far from the goal it is, in tolerances, else the output itself; None where it was not measured."""
        cost = self.cost(result)
        if not math.isfinite(cost):
            return None
        name = "from the goal, in tolerances" if self.aim == "reach" else self.outputs[0]
        sigma = self._spread(result, {n: result.get(f"{n}_sigma", 0.0) or 0.0 for n in self.outputs})
        return {"name": name, "value": -cost if self.aim == "maximize" else cost, "sigma": sigma}

    def noise(self, result: Mapping[str, float]) -> float:
        """Return one standard deviation by which the cost differs between readings of the same; 0 if unknown."""
        return self._spread(result, {n: noise_of(result, n) for n in self.outputs})

    def _spread(self, result: Mapping[str, float], sigmas: Mapping[str, float]) -> float:
        """Return one standard deviation of the cost of a result, by those of its outputs."""
        if self.aim != "reach":
            return sigmas[self.outputs[0]]
        cost = self.cost(result)
        if not math.isfinite(cost) or cost == 0:
            return math.hypot(*(s / (self.tolerance.get(n) or 1.0) for n, s in sigmas.items()))
        parts = ((off / (self.tolerance.get(n) or 1.0) ** 2 / cost * sigmas[n]) for n, off in self.off(result).items())
        return math.hypot(*parts)


def noise_of(result: Mapping[str, float], output: str) -> float:
    """Return one standard deviation by which readings of the same output differ, without what all of them have in
    common; 0 if unknown."""
    return result.get(f"{output}_noise_sigma", result.get(f"{output}_sigma", 0.0)) or 0.0


def missing(algorithm: str, package: str) -> PicoError:
    """Return that an algorithm needs a package which is not installed, and how it is."""
    text = f"{algorithm} needs the package `{package}`, which is not installed"
    return PicoError(error("extra", text, hint="`pip install 'pico-lab[optimize]'` installs it"))


class Short(str):
    """Why something ends that is short of the best: no goal is met by it, however good the last reading is."""


class Algorithm(Protocol):
    """Something that is asked for points to try, and told what was measured there."""

    def suggest(self, num_points: int | None = None) -> list[Point]:
        """Return the next points to try, within the bounds, `num_points` of them or fewer (one where that is None);
        none where there is nothing more to try."""
        ...

    def ingest(self, results: Sequence[Mapping[str, float]]) -> None:
        """Hear what was measured: points with their outputs, in any order, those of others too."""
        ...

    @property
    def finished(self) -> str:
        """Why nothing more is to be tried, empty while something is; a `Short` where that is not the best."""
        ...


@dataclass(frozen=True)
class Solution:
    """Where an algorithm's model of the readings has the best, with one standard deviation of each tunable."""

    point: Mapping[str, float]
    sigma: Mapping[str, float]


@runtime_checkable
class Solver(Protocol):
    """An algorithm with a model of the readings, that knows better than the best reading where the best is."""

    @property
    def solution(self) -> Solution | None:
        """Where the best is once the algorithm is `finished`; None where it could not tell."""
        ...


@dataclass(frozen=True)
class Declaration:
    """What a file of algorithms brings: its name is the file's. `aims` that it can, how many `variables` and `outputs`
    it takes (least and most), its `parameters` with their defaults, and how many measurements are `usual`, and how many
    where it is `told` how the outputs change with the tunables (0: as many). `solves`: it is a `Solver`."""

    what: str
    aims: tuple[Aim, ...]
    variables: tuple[int, int]
    outputs: tuple[int, int] = (1, 1)
    parameters: Mapping[str, float] = field(default_factory=dict)
    usual: int = 40
    told: int = 0
    solves: bool = False

    def refusal(self, problem: Problem) -> str:
        """Return why it cannot solve a problem, in words that follow its name; empty where it can."""
        least, most = self.variables
        if not least <= len(problem.variables) <= most:
            how = f"{least}" if least == most else f"{least} to {most}"
            return f"takes {how} tunables, not {len(problem.variables)}"
        least, most = self.outputs
        if not least <= len(problem.outputs) <= most:
            how = f"{least}" if least == most else f"{least} to {most}"
            return f"needs {how} numbers measured, not {len(problem.outputs)}"
        if problem.aim not in self.aims:
            return f"cannot {problem.aim}"
        if problem.offset is not None and not self.solves:
            return "does not tell where the best is by its model, from which an offset could be counted"
        return ""
