"""What light is to be brought to on one bench: goals of its Lab, ready-made ones, and the plans that reach them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnostics import PicoError, did_you_mean, error
from pico.model.lab import Goal, Setup
from pico.model.vocabulary import numbers_of
from pico.optimize.problem import Problem, Variable

if TYPE_CHECKING:
    from pico.bench.aligned import Alignment
    from pico.model.event import Event
    from pico.model.plan import Plan
    from pico.model.report import RunReport

READY: Mapping[str, str] = {
    "centre": "PART... CAMERA: its spot in the middle of the camera, to 5 um",
    "focus": "PART... CAMERA: the smallest spot on the camera",
    "peak": "PART... DETECTOR: as much light as can be",
    "null": "PART... DETECTOR: as little light as can be",
}
"""Goals that need no entry in `lab.yaml`, and what they are told."""
CENTRED = 5.0
"""How near the middle of a camera is near enough [um]."""
_ACROSS = ("stage_y", "stage_z", "tip", "tilt", "pinhole_y", "pinhole_z")
_TURNED = ("angle",)
_ALONG = ("stage_x", "piezo")


@dataclass(frozen=True)
class Chosen:
    """A goal by name with the algorithm that is to reach it, and why that one; `seconds` that it is likely to take."""

    name: str
    goal: Goal
    algorithm: str
    why: str
    seconds: float


@dataclass(frozen=True)
class Optimized:
    """What became of an optimization: see `pico.edge.aligning` for its data."""

    goal: str = ""
    algorithm: str = ""
    met: bool = False
    why: str = "it did not begin"
    measurements: int = 0
    seconds: float = 0.0
    first: Mapping[str, float] | None = None
    last: Mapping[str, float] | None = None
    columns: tuple[str, ...] = ()
    tolerance: Mapping[str, float] = field(default_factory=dict)
    points: Mapping[str, Any] | None = None


def optimized(events: Sequence[Event]) -> Optimized:
    """Return what the events of a run say of the optimization in it."""
    for event in events:
        if event.kind == "operation_done" and "algorithm" in event.data and "columns" in event.data:
            known = {k: v for k, v in event.data.items() if k in Optimized.__dataclass_fields__}
            return Optimized(**{**known, "columns": tuple(event.data["columns"])})
        if event.kind in ("operation_failed", "operation_unknown"):
            return Optimized(why=str(event.data["diagnostic"].get("summary", "")))
    return Optimized()


class Goals:
    """Goals on one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    @property
    def named(self) -> Mapping[str, Goal]:
        """The goals of the Lab, by name."""
        return self.opened.setup.lab.goals or {}

    def alignments(self) -> tuple[Alignment, ...]:
        """Return how the goals of the Lab stand, as the journal knows; nothing is measured."""
        from pico.bench.aligned import standing

        return standing(self.opened, self.opened.observe())

    def chosen(self, words: Sequence[str] | Goal, name: str = "asked", algorithm: str | None = None) -> Chosen:
        """Return a goal: of the Lab by its name, a ready-made one (`centre ly_150 cam`), or the one given, as `name`;
        and the algorithm, `algorithm` where that is said. Raises PicoError for what is wrong with it."""
        from pico.manifest.checks.goals import require_goal
        from pico.optimize.registry import made
        from pico.planning.optimizing import algorithm_for, seconds

        setup = self.opened.setup
        if not isinstance(words, Goal):
            name, goal = self._of(list(words))
        else:
            goal = words
        goal = replace(goal, algorithm=algorithm or goal.algorithm)
        require_goal(setup, name, goal)
        found, why = (goal.algorithm, "as the goal says") if goal.algorithm else algorithm_for(setup, goal)
        made(found, as_problem(goal), goal.parameters)  # raises for what it cannot, or does not have
        return Chosen(name, goal, found, why, seconds(setup, goal, found))

    def _of(self, words: list[str]) -> tuple[str, Goal]:
        setup, first = self.opened.setup, words[0]
        if first in self.named and len(words) == 1:
            return first, self.named[first]
        if first not in READY:
            known = (*self.named, *READY)
            hint = did_you_mean(first[:40], known) or f"known: {', '.join(known)}"
            raise PicoError(error("goal", f"{setup.lab.name} has no goal `{first[:40]}`", hint=hint))
        if len(words) < 3:
            raise PicoError(error("goal", f"`{first}` takes what to tune and what to see it by", hint=READY[first]))
        return f"{first} {' '.join(words[1:])}", ready(setup, first, words[1:-1], words[-1])

    def plan(self, chosen: Chosen) -> Plan:
        """Return the plan that brings light to a goal; raises PicoError."""
        return Plans(self.opened).to_goal(chosen.name, chosen.goal, chosen.algorithm)

    def optimize(
        self, plan: Plan, show: Callable[[Event], None] = lambda _: None, say: Callable[[str], None] = lambda _: None
    ) -> tuple[RunReport, Optimized]:
        """Run the plan of a goal, and return what became of the run and of the goal. `show` gets each event; Ctrl-C
        ends it at the best point, of which `say` is told."""
        from pico.bench.moves import Moves
        from pico.bench.running.attending import attend

        run, events = Moves(self.opened).run(plan, holder="pico optimize"), list[Any]()

        def heard(event: Event) -> None:
            events.append(event)
            show(event)

        attend(run, heard, say)
        return run.report, optimized(events)

    def plot(self, found: Optimized, out: Path) -> None:
        """Write the plot of an optimization as PNG; raises PicoError where its points are gone, or it can't be."""
        from pico.content.arrays import load_array
        from pico.content.store import store_of
        from pico.drawing.picture import write_png
        from pico.drawing.plots.search import search_plot
        from pico.model.measurement import ArrayRef

        reference = ArrayRef(**{**(found.points or {}), "shape": tuple((found.points or {})["shape"])})
        points = load_array(store_of(self.opened.folder.root), reference)
        setup, units = self.opened.setup, dict[str, str]()
        names = [c for c in found.columns if c != "time" and not c.endswith("_sigma")]
        tunables = [n for n in names if n.partition(".")[0] in setup.lab.inventory and n not in found.tolerance]
        for name in tunables:
            kind = setup.type_of(name.partition(".")[0]).tunables.get(name.partition(".")[2])
            units[name] = kind.unit if kind else ""
        outputs = {n: (self._target(found, n)) for n in names if n not in units}
        write_png(search_plot(f"{found.goal}: {found.algorithm}", found.columns, points, outputs, units), out)

    def _target(self, found: Optimized, output: str) -> float | None:
        goal = self.named.get(found.goal)
        return None if output not in found.tolerance else (goal.reach or {}).get(output, 0.0) if goal else 0.0


def as_problem(goal: Goal) -> Problem:
    """Return what an algorithm is asked, but for where the tunables stand."""
    variables = tuple(Variable(name, low, high, low) for name, (low, high) in goal.tunables.items())
    return Problem(variables, tuple(goal.reach or ("objective",)), goal.aim)


def ready(setup: Setup, what: str, parts: Sequence[str], detector: str) -> Goal:
    """Return a ready-made goal; raises PicoError for parts that it cannot be made of."""
    tunables: dict[str, tuple[float, float]] = {}
    for part in parts:
        tunables |= _tunables(setup, what, part)
    if detector not in setup.lab.inventory:
        raise _no_part(setup, detector)
    numbers = numbers_of(setup, detector)
    if what == "centre":
        wanted = [f"{detector}.centroid.{axis}" for axis in ("x", "y")]
        if "centroid.x" not in numbers:
            raise PicoError(error("goal", f"{detector} does not measure a centroid", hint="a camera does"))
        return Goal(tunables=tunables, reach=dict.fromkeys(wanted, 0.0), tolerance=CENTRED)
    if what == "focus":
        if "width.major" not in numbers:
            raise PicoError(error("goal", f"{detector} does not measure a width", hint="a camera does"))
        return Goal(tunables=tunables, minimize=f"{detector}.width.major")
    light = next((n for n in ("power", "voltage") if n in numbers), None)
    if light is None:
        raise PicoError(error("goal", f"{detector} measures no power", hint="a power meter, a photodiode, a camera"))
    wanted_of = f"{detector}.{light}"
    if what == "peak":
        return Goal(tunables=tunables, maximize=wanted_of)
    return Goal(tunables=tunables, minimize=wanted_of)


def _tunables(setup: Setup, what: str, part: str) -> dict[str, tuple[float, float]]:
    """Return what of a part a ready-made goal tunes, with its whole range as bounds."""
    component, _, one = part.partition(".")
    if component not in setup.lab.inventory:
        raise _no_part(setup, component)
    kinds = setup.type_of(component).tunables
    usual = _ALONG if what == "focus" else _TURNED if what == "null" and "angle" in kinds else _ACROSS
    wanted = (one,) if one else usual
    found = [n for n in wanted if n in kinds] or [n for n in (*_TURNED, *_ALONG) if n in kinds and not one]
    if not found:
        hint = f"it has: {', '.join(kinds) or 'none'}"
        raise PicoError(error("goal", f"{part} has nothing to tune for `{what}`", hint=hint))
    return {f"{component}.{name}": _bounds(component, name, setup) for name in found}


def _no_part(setup: Setup, name: str) -> PicoError:
    hint = did_you_mean(name, setup.lab.inventory) or "`pico catalog parts` lists them"
    return PicoError(error("goal", f"there is no component `{name}`", hint=hint))


def _bounds(component: str, name: str, setup: Setup) -> tuple[float, float]:
    kind = setup.type_of(component).tunables[name]
    if kind.range is not None:
        return kind.range
    if kind.period is not None:
        return -kind.period / 2, kind.period / 2
    text = f"{component}.{name} has no range, within which it could be searched"
    raise PicoError(error("goal", text, hint="a goal in `lab.yaml` says its own bounds"))
