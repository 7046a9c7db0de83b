"""Which set-points of its target a plan leaves for light to find, and which goals of the Lab it spoils."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from pico.diagnostics import Diagnostic, warning
from pico.model.observation import Observation
from pico.model.plan import Plan, Spoiled
from pico.model.setup import Setup
from pico.model.state import LabState, goals_of, references_of
from pico.planning.alignment import (
    Alignment,
    goals_unmet_after,
    references_off,
    references_staying,
    spoiled_goals,
)
from pico.planning.by_light import told_of, with_goals


@dataclass(frozen=True)
class GoalRecord:
    """What is known of the goals of a bench, asked only if a plan concerns one."""

    # The state that the manifest wants; None if it can't be read.
    manifest: Callable[[], LabState | None]
    # How the goals of the Lab stand, and those that references of a state are, its parts where that wants them.
    standing: Callable[[LabState], Sequence[Alignment]]


def judge_goals(
    setup: Setup, plan: Plan, seen: Observation, known: GoalRecord
) -> tuple[tuple[Diagnostic, ...], tuple[Spoiled, ...]]:  # fmt: skip
    """Return which set-points of the state that a plan leads to light has yet to find, and which goals of the Lab the
    plan spoils. Nothing for a plan that concerns no goal."""
    state = wanted = plan.target_state
    if not references_of(wanted):
        state = known.manifest() or wanted
    values_of_goals = {c.aligned.goal for c in plan.changes if c.aligned}
    if not (references_of(state) or values_of_goals or (setup.lab.goals and plan.operations)):
        return (), ()
    stands = known.standing(state)
    sought = with_goals(setup, told_of(setup, seen, state, wanted=True))
    by_light = references_of(wanted)
    unmet = references_off(stands, state, plan.operations) if by_light else references_staying(plan, state)
    found, references = [*spoiled_goals(sought, seen, stands, plan.operations)], goals_of(state)
    stale = tuple(
        warning(
            "by-light", f"{one.goal} is aligned, and will not be: {why} changes",
            hint=f"then `pico optimize {one.goal}`, about {one.seconds:.0f} s",
            address=next(iter(references[one.goal])),
        )
        for one, why in found if one.goal in references  # set-points of the state, which the bench will not equal
    )  # fmt: skip
    lost = [Spoiled(goal=o.goal, why=f"{w} changes", at=o.at, seconds=o.seconds) for o, w in found]
    lost += [
        Spoiled(goal=one.goal, why=one.why or one.status, at=one.at, seconds=one.seconds)
        for one in goals_unmet_after(setup, seen, stands, plan.operations) if one.goal in values_of_goals
    ]  # fmt: skip
    return (*unmet, *stale), tuple(one for one in lost if one.goal not in references)
