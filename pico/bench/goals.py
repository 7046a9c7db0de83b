"""What light is to be brought to on one bench: goals of its Lab, ready-made ones, and the plans that reach them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.bench.opened import Opened
from pico.bench.plans import Plans
from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.model.goal import Goal
from pico.model.state import goals_of, references_of
from pico.optimize.problem import Problem, Variable
from pico.planning.asked import Ready

if TYPE_CHECKING:
    from pico.model.plan import Plan
    from pico.model.trace.event import Event
    from pico.model.trace.report import RunReport
    from pico.planning.alignment import Alignment
    from pico.planning.sought import Sought


@dataclass(frozen=True)
class Chosen:
    """A goal with the algorithm that is to reach it, what is sought `first` where it is dark, and the seconds that it
    is likely to take."""

    one: Sought
    first: tuple[Sought, ...]
    seconds: float

    @property
    def name(self) -> str:
        return self.one.name

    @property
    def goal(self) -> Goal:
        return self.one.goal

    @property
    def algorithm(self) -> str:
        return self.one.algorithm

    @property
    def why(self) -> str:
        return self.one.why


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
    stages: tuple[Mapping[str, Any], ...] = ()
    solution: Mapping[str, float] | None = None
    saturated: bool = False

    def __repr__(self) -> str:
        said = "met" if self.met else "not met"
        spent = f"{self.measurements} measurements, {self.seconds:.1f} s, {self.algorithm or 'no algorithm'}"
        return f"<{self.goal or 'goal'}: {said} ({spent}): {self.why}>"


def optimized(events: Sequence[Event]) -> Optimized:
    """Return what the events of a run say of the optimization in it."""
    for event in events:
        if event.kind == "operation_done" and "algorithm" in event.data and "columns" in event.data:
            known = {k: v for k, v in event.data.items() if k in Optimized.__dataclass_fields__}
            stages = tuple(event.data.get("stages") or ())
            return Optimized(**{**known, "columns": tuple(event.data["columns"]), "stages": stages})
        if event.kind in ("operation_failed", "operation_unknown"):
            return Optimized(why=str(event.data["diagnostic"].get("summary", "")))
    return Optimized()


class Goals:
    """Goals on one bench."""

    def __init__(self, opened: Opened) -> None:
        self.opened = opened

    @property
    def named(self) -> Mapping[str, Goal]:
        """The goals of the Lab by name, and those that set-points of the manifest are which light finds, by address."""
        state, setup = self.opened.folder.state_now(), self.opened.setup
        if state is None or not references_of(state):
            return setup.lab.goals or {}
        from pico.planning.by_light import told_of

        return {**(setup.lab.goals or {}), **told_of(setup, self.opened.observe(), state).goals}

    def alignments(self) -> tuple[Alignment, ...]:
        """Return how the goals stand, as the journal knows; nothing is measured."""
        from pico.bench.aligned import standing

        return standing(self.opened, self.opened.observe(), self.opened.folder.state_now())

    def chosen(
        self, words: Sequence[str] | Goal, name: str = "asked", algorithm: str | None = None,
        offline: float | None = None,
    ) -> Chosen:  # fmt: skip
        """Return a goal: of the Lab by its name, a ready-made one (`center ly_150 cam`), or the one given, as `name`;
        and the algorithm, `algorithm` where that is said. `offline`: how long it may go on where the bench is cut off
        from its coordinator [s], instead of what its budget says. Raises PicoError for what is wrong with it."""
        from pico.manifest.checks.goals import require_goal
        from pico.optimize.registry import made
        from pico.planning.sought import stages

        setup, seen = self.opened.setup, self.opened.observe()
        found = Ready(name, words) if isinstance(words, Goal) else self._of(list(words))
        if offline is not None:
            found = replace(found, goal=replace(found.goal, budget=replace(found.goal.budget, offline=offline)))
        for label, goal in (*found.first, (found.name, found.goal)):
            require_goal(setup, label, goal)
        one, first = stages(setup, seen, found, algorithm)
        made(one.algorithm, as_problem(one), one.goal.parameters)  # raises for what it cannot, or does not have
        return Chosen(one, first, self._takes(one, first))

    def _takes(self, one: Sought, first: Sequence[Sought]) -> float:
        from pico.bench.aligned import experience
        from pico.planning.optimizing import reckoned

        known = experience(self.opened, one.name, one.goal, one.algorithm)
        return reckoned(self.opened.setup, (*first, one)) if known is None else known

    def _of(self, words: list[str]) -> Ready:
        from pico.bench.ready.registry import current, known, made_ready

        goals = self.opened.setup.lab.goals or {}
        if words[0] in goals and len(words) == 1:
            return Ready(words[0], goals[words[0]])
        if (found := self._referred(words)) is not None:
            return found
        what, *_ = words = list(current(words))
        if what not in known():
            names = (*self.named, *known())
            hint = did_you_mean(what[:40], names) or f"known: {', '.join(names)}"
            if what in (self.opened.folder.described.lab.goals or {}):
                hint = "lab.yaml describes it, and the bench has not adopted that yet: `pico bench update`"
            raise PicoError(error("goal", f"{self.opened.setup.lab.name} has no goal `{what[:40]}`", hint=hint))
        return made_ready(self.opened.setup, self.opened.observe(), words)

    def _referred(self, words: Sequence[str]) -> Ready | None:
        """Return the goal of set-points that light finds by its name (`through iris1 iris2`), or by the address of one
        of them; None where the manifest has none such. Raises PicoError where it can't be sought."""
        state = self.opened.folder.state_now()
        goals = goals_of(state) if state else {}
        said = {" ".join(words), " ".join((words[0], *sorted(words[1:])))}
        name = next((n for n, of in goals.items() if n in said or (len(words) == 1 and words[0] in of)), None)
        if name is None:
            return None
        from pico.planning.by_light import sought_in

        found = sought_in(self.opened.setup, self.opened.observe(), state)
        if name in found.wrong:
            raise PicoError(found.wrong[name])
        return found.ready[name]

    def cautions(self, chosen: Chosen) -> tuple[Diagnostic, ...]:
        """Return what the goal cannot tell of its tunables, and which of these stand outside of where they are
        searched, as warnings; by the nominal way of light on the bench as it is seen."""
        from pico.optics.nominal.sensitivity import cautions
        from pico.planning.goal_light import standing_poses

        setup, seen = self.opened.setup, self.opened.observe()
        poses = {n: pose for n, pose in standing_poses(seen).items() if n in setup.lab.inventory}
        return cautions(setup, poses, seen.known_values, chosen.goal)

    def plan(self, chosen: Chosen, *, absorb: bool = True) -> Plan:
        """Return the plan that brings light to a goal; raises PicoError. `absorb`: its tunables make up first for how
        parts were seen to stand since light was right, see `pico.optics.nominal.feeding`."""
        return Plans(self.opened).to_goal(chosen.one, chosen.first, chosen.seconds, absorb=absorb)

    def optimize(
        self, plan: Plan, show: Callable[[Event], None] = lambda _: None, say: Callable[[str], None] = lambda _: None,
        came: list[int] | None = None,
    ) -> tuple[RunReport, Optimized]:  # fmt: skip
        """Run the plan of a goal, and return what became of the run and of the goal. `show` gets each event; Ctrl-C
        ends it at the best point, of which `say` is told. `came` gets the signals that ended it."""
        from pico.bench.moves import Moves
        from pico.bench.running.attending import attend

        run, events = Moves(self.opened).run(plan, holder="pico optimize"), list[Any]()

        def heard(event: Event) -> None:
            events.append(event)
            show(event)

        signals = attend(run, heard, say)
        if came is not None:
            came += signals
        return run.report, optimized(events)

    def plot(self, found: Optimized, goal: Goal, out: Path) -> None:
        """Write the plot of an optimization as PNG; raises PicoError where its points are gone, or it can't be."""
        from pico.bench.picturing.searches import search_of
        from pico.content.arrays import load_array
        from pico.content.store import store_of
        from pico.drawing.picture import write_png
        from pico.model.measurement import ArrayRef

        reference = ArrayRef(**{**(found.points or {}), "shape": tuple((found.points or {})["shape"])})
        points = load_array(store_of(self.opened.folder.root), reference)
        write_png(search_of(self.opened.setup, found.goal, goal, vars(found), points).picture(), out)


def as_problem(one: Sought) -> Problem:
    """Return what an algorithm is asked, but for where the tunables stand."""
    variables = tuple(Variable(name, low, high, low) for name, (low, high) in one.goal.tunables.items())
    offset = None if one.goal.offset is None else {variables[0].name: one.goal.offset}
    outputs = tuple(one.goal.reach or ("objective",))
    return Problem(variables, outputs, one.goal.aim, nominal=one.known, offset=offset)
