"""What an optimization is told: its goal, its algorithm, what nominal geometry says, and the same of the goals that are
sought before it where it is dark."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pico.model.goal import Goal, goal_from_json
from pico.model.observation import Observation
from pico.model.record import as_json
from pico.model.setup import Setup
from pico.model.vocabulary import measured_in
from pico.optimize.choosing import Tuned, choose, usual_parameters
from pico.optimize.problem import Nominal, nominal_from_json
from pico.planning.asked import Ready
from pico.planning.nominal import aimed_in_the_dark, nominal, set_to

_NUMBER = re.compile(r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)+")
"""One number of what is measured, and nothing else."""


@dataclass(frozen=True)
class Sought:
    """A goal by name, the algorithm that brings light to it, why that one, and what is known before it begins. `aim`:
    to what its tunables are set first, where nobody knows what they were when it was met."""

    name: str
    goal: Goal
    algorithm: str
    why: str = ""
    known: Nominal | None = None
    aim: Mapping[str, float] | None = None


def sought(
    setup: Setup, seen: Observation, name: str, goal: Goal, former: Sequence[Goal] = (), algorithm: str | None = None,
    aim: Mapping[str, float] | None = None,
) -> Sought:  # fmt: skip
    """Return a goal with its algorithm: `algorithm`, else its own, else the one that suits it; `former`: goals that
    will have been met before it. `aim`: where its tunables will begin."""
    known = nominal(setup, set_to(seen, aim or {}), goal, former)
    if asked := algorithm or goal.algorithm:
        return Sought(name, goal, asked, "as asked" if algorithm else "as the goal says", known, aim)
    return Sought(name, goal, *algorithm_for(setup, goal, known=known is not None), known, aim)


def stages(
    setup: Setup, seen: Observation, ready: Ready, algorithm: str | None = None
) -> tuple[Sought, tuple[Sought, ...]]:  # fmt: skip
    """Return what a goal that was made ready is sought as, and what is sought first where it is dark. If by how mirrors
    are set its light misses where it is wanted, the ray model says where they are set first."""
    aim = ready.aim or aimed_in_the_dark(setup, seen, ready.goal)
    first = tuple(
        sought(setup, seen, label, goal, aim={a: v for a, v in aim.items() if a in goal.tunables})
        for label, goal in ready.first
    ) or before(setup, seen, ready.goal)  # fmt: skip
    former = [stage.goal for stage in first]
    return sought(setup, seen, ready.name, ready.goal, former, algorithm, aim or None), first


def before(setup: Setup, seen: Observation, goal: Goal) -> tuple[Sought, ...]:
    """Return the goals of the Lab that a goal comes after, with what those come after, in the order in which they are
    sought."""
    goals = setup.lab.goals or {}
    names: list[str] = []

    def add(one: Goal, within: tuple[str, ...]) -> None:
        for name in one.after or ():
            if name in goals and name not in within:
                add(goals[name], (*within, name))
                names.extend([name] if name not in names else [])

    add(goal, ())
    return tuple(
        sought(setup, seen, name, goals[name], [goals[n] for n in names[:at]]) for at, name in enumerate(names)
    )


def arguments_of(setup: Setup, one: Sought, first: Sequence[Sought] = ()) -> dict[str, Any]:
    """Return the arguments of an optimization, but for where its tunables stand; `first`: goals that come before it."""

    def told(stage: Sought) -> dict[str, Any]:
        own = {**usual_parameters(stage.algorithm, tuned(setup, stage.goal)), **(stage.goal.parameters or {})}
        known = {"nominal": stage.known} if stage.known else {}
        whole = {"what": stage.goal, **known}
        return {"goal": stage.name, "algorithm": stage.algorithm, "parameters": own, **as_json(whole)}

    return {**told(one), **({"first": [told(stage) for stage in first]} if first else {})}


def sought_by(arguments: Mapping[str, Any]) -> tuple[Sought, tuple[Sought, ...]]:
    """Return what an optimization with these arguments seeks, and what it seeks first."""

    def told(of: Mapping[str, Any]) -> Sought:
        known = nominal_from_json(of.get("nominal"))
        return Sought(str(of["goal"]), goal_from_json(of["what"]), str(of["algorithm"]), "as before", known)

    return told(arguments), tuple(told(one) for one in arguments.get("first") or ())


def algorithm_for(setup: Setup, goal: Goal, *, known: bool = False) -> tuple[str, str]:
    """Return the algorithm that suits a goal, and why; `known`: whether `nominal` tells how its tunables move light."""
    kernels = []
    for text in goal.reach or (goal.texts[0],):
        # what is composed of numbers does not follow the law of one of them
        of = measured_in(setup, [plain]) if _NUMBER.fullmatch(plain := goal.plain(text).strip()) else []
        kernel = setup.measurables_of(of[0][0])[of[0][1]].kernel if of else None
        kernels.append((kernel or "").rpartition("|")[2].strip().partition("(")[0])
    return choose(tuned(setup, goal), kernels, goal.aim, known=known)


def tuned(setup: Setup, goal: Goal) -> list[Tuned]:
    """Return the tunables of a goal as they count for the choice of an algorithm."""
    found = []
    for address in goal.tunables:
        component, _, name = address.partition(".")
        kind = setup.type_of(component)
        found.append(Tuned(kind.optics.element, name, kind.tunables[name].period))
    return found


def tunables_of(one: Sought, first: Sequence[Sought] = ()) -> Mapping[str, tuple[float, float]]:
    """Return what is tuned for a goal, and for those before it, with the bounds."""
    return {a: bounds for stage in (*first, one) for a, bounds in stage.goal.tunables.items()}
