"""How goals stand on a bench, and which of them operations spoil: pure functions, nothing is measured."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from pico.diagnostics import Diagnostic, warning
from pico.model.goal import Goal
from pico.model.observation import Observation
from pico.model.operation import Operation, searched_by, touched_by
from pico.model.plan import Plan
from pico.model.setup import Setup
from pico.model.state import LabState, goals_of, references_of
from pico.planning.foreseen import foreseen
from pico.planning.goal_light import goal_light

_LIT = ("shutter", "emission", "illumination")
"""Tunables that let light out, and leave its way as it is."""
PUT_BACK = ("survey",)
"""Primitives that leave their tunables as they were."""
ALONG = ("interlock", "parked")
"""Reasons of operations that leave light as it was when they are over."""


Status = Literal["aligned", "stale", "lost", "never measured"]


@dataclass(frozen=True)
class Alignment:
    """How a goal stands: `why` where it is not aligned; `at` by the wall, and `last`, what was measured then; `order`:
    how far along the beam its first tunable stands [mm], None where its light does not come through all that is tuned
    to all that is measured; `seconds` that it takes to be sought again, and whether that is by `experience`."""

    goal: str
    status: Status
    why: str = ""
    at: str = ""
    last: Mapping[str, float] | None = None
    order: float | None = None
    seconds: float = 0.0
    experience: bool = False


def spoiled_goals(
    setup: Setup, seen: Observation, standing: Sequence[Alignment], operations: Sequence[Operation]
) -> Iterator[tuple[Alignment, str]]:
    """Yield each goal that is aligned now and will not be after a plan, where there still is light for it, with what
    changes in its light; in the order along the beam."""
    then = foreseen(setup, seen, operations)
    for one in standing:
        wrong = _upset_by(setup, seen, one.goal, operations) if one.status == "aligned" else ""
        if wrong and goal_light(setup, then, (setup.lab.goals or {})[one.goal]).order is not None:
            yield one, wrong


def goals_unmet_after(
    setup: Setup, seen: Observation, standing: Sequence[Alignment], operations: Sequence[Operation]
) -> Iterator[Alignment]:
    """Yield each goal of the Lab that is not aligned now, is not sought by a plan, and has light after it; in the order
    along the beam."""
    then = foreseen(setup, seen, operations)
    sought = {op.arguments.get("goal") for op in operations if op.primitive == "optimize"}
    for one in standing:
        goal = (setup.lab.goals or {}).get(one.goal)
        waiting = goal is not None and one.status != "aligned" and one.goal not in sought
        if waiting and goal is not None and goal_light(setup, then, goal).order is not None:
            yield one


def _upset_by(setup: Setup, seen: Observation, name: str, operations: Sequence[Operation]) -> str:
    """Return which of what operations touch a goal depends on, as its light runs before them or after; empty for none,
    and where one of them seeks it."""
    touched = {
        one
        for op in operations
        if op.reason.kind not in ALONG and op.kind.mutating and op.primitive not in PUT_BACK
        for one in left_changed(op.component, op.arguments)
    }
    own = [op for op in operations if op.primitive == "optimize" and op.arguments.get("goal") == name]
    goal = (setup.lab.goals or {})[name]
    if own or not touched:
        return ""
    return upset_in(setup, seen, goal, touched) or upset_in(setup, foreseen(setup, seen, operations), goal, touched)


def left_changed(component: str, arguments: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield what an operation leaves changed: of an optimization what it searched, as it sets all else back."""
    if searched := searched_by(arguments):
        yield from ((one, tunable) for one, _, tunable in (address.partition(".") for address in searched))
    else:
        yield from touched_by(component, arguments)


def upset_in(setup: Setup, seen: Observation, goal: Goal, touched: Collection[tuple[str, str]]) -> str:
    """Return which of what is touched its light depends on: a tunable of the goal, or a part in the beams to where it
    is measured; empty for none."""
    light = goal_light(setup, seen, goal)
    own = {*(goal.during or ())}.union(*(goal.looks or {}).values())
    for component, tunable in sorted(touched):
        if f"{component}.{tunable}" in goal.tunables:
            return f"{component}.{tunable}"
        harmless = tunable in _LIT or f"{component}.{tunable}" in own or component in light.beyond
        if component in light.parts and not harmless and (tunable == "pose" or component not in light.detectors):
            return component if tunable == "pose" else f"{component}.{tunable}"
    return ""


def references_off(
    standing: Sequence[Alignment], state: LabState, operations: Sequence[Operation] = ()
) -> Iterator[Diagnostic]:
    """Yield for each reference of a state that is not aligned what it is to be, why it is not, and what that takes; a
    note where one of the operations of a plan seeks it."""
    sought = {str(op.arguments.get("goal")) for op in operations if op.primitive == "optimize"}
    goals = goals_of(state)
    for one in standing:
        if one.goal not in goals or one.status == "aligned":
            continue
        (address, reference), *more = goals[one.goal].items()
        named, it = (", ".join(goals[one.goal]), "them") if more else (address, "it")
        text = f"{named} {'are' if more else 'is'} to stand {reference.text}: {standing_text(one)}"
        if one.goal in sought:
            yield Diagnostic("note", "by-light", text, hint=f"this plan finds {it}", address=address)
            continue
        hint = f"`pico optimize {one.goal}` finds {it}, about {one.seconds:.0f} s" if one.seconds else ""
        yield warning("by-light", text, hint=hint, address=address)


def references_staying(plan: Plan, state: LabState) -> Iterator[Diagnostic]:
    """Yield for each reference of the manifest whose tunable single operations set that it stays in the manifest."""
    changed = [op for op in plan.operations if op.primitive != "optimize" and op.reason.kind == "asked"]
    touched = {f"{c}.{tunable}" for op in changed for c, tunable in touched_by(op.component, op.arguments)}
    for address, one in references_of(state).items():
        if address in touched and plan.target.cause == "single":
            text = f"{address} stays {one.text} in the manifest, whatever it is set to"
            hint = f"`pico optimize {one.goal(address)}` brings it there"
            yield Diagnostic("note", "by-light", text, hint=hint, address=address)


def standing_text(one: Alignment) -> str:
    """Return how a goal stands, in words."""
    return f"{one.status}: {one.why}" if one.why and one.status != "never measured" else one.why or one.status
