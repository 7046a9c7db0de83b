"""Set-points that light finds, on one bench: goals beside those of its Lab, and equal to it while they are aligned."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from pico.bench.aligned import Alignment, stands
from pico.diagnostics import Diagnostic, warning
from pico.model.diff import Change
from pico.model.observation import Observation
from pico.model.operation import Operation, touched_by
from pico.model.setup import Setup
from pico.model.state import LabState, goals_of, references_of

if TYPE_CHECKING:
    from pico.model.plan import Plan
    from pico.runs.memory import Memory


def unaligned(setup: Setup, memory: Memory | None, seen: Observation, state: LabState) -> dict[str, str]:
    """Return the references of a state that are not equal to the bench by their address, each with the reason."""
    goals = goals_of(state)
    if not goals:
        return {}
    off = [one for one in stands(setup, memory, seen, state) if one.status != "aligned"]
    return {address: said(one) for one in off for address in goals.get(one.goal, ())}


def unfound(setup: Setup, memory: Memory | None, seen: Observation, state: LabState) -> tuple[Change, ...]:
    """Return how the bench has left where light says that it should be, as it happened: `after` is live."""
    changes = []
    references = references_of(state)
    for address, why in unaligned(setup, memory, seen, state).items():
        component, _, tunable = address.partition(".")
        goal, live = references[address], seen.known_values.get(component, {}).get(tunable)
        changes.append(
            Change(component=component, tunable=tunable, before=goal.as_json(), after=live, text=f"{goal.text}: {why}")
        )
    return tuple(changes)


def told(standing: Sequence[Alignment], state: LabState, operations: Sequence[Operation] = ()) -> Iterator[Diagnostic]:
    """Yield for each reference of a state that is not aligned what it is to be, why it is not, and what that takes; a
    note where one of the operations of a plan seeks it."""
    sought = {str(op.arguments.get("goal")) for op in operations if op.primitive == "optimize"}
    goals = goals_of(state)
    for one in standing:
        if one.goal not in goals or one.status == "aligned":
            continue
        (address, reference), *more = goals[one.goal].items()
        named, it = (", ".join(goals[one.goal]), "them") if more else (address, "it")
        text = f"{named} {'are' if more else 'is'} to stand {reference.text}: {said(one)}"
        if one.goal in sought:
            yield Diagnostic("note", "by-light", text, hint=f"this plan finds {it}", address=address)
            continue
        hint = f"`pico optimize {one.goal}` finds {it}, about {one.seconds:.0f} s" if one.seconds else ""
        yield warning("by-light", text, hint=hint, address=address)


def staying(plan: Plan, state: LabState) -> Iterator[Diagnostic]:
    """Yield for each reference of the manifest whose tunable single operations set that it stays in the manifest."""
    changed = [op for op in plan.operations if op.primitive != "optimize" and op.reason.kind == "asked"]
    touched = {f"{c}.{tunable}" for op in changed for c, tunable in touched_by(op.component, op.arguments)}
    for address, one in references_of(state).items():
        if address in touched and plan.target.cause == "single":
            text = f"{address} stays {one.text} in the manifest, whatever it is set to"
            hint = f"`pico optimize {one.goal(address)}` brings it there"
            yield Diagnostic("note", "by-light", text, hint=hint, address=address)


def said(one: Alignment) -> str:
    """Return how a goal stands, in words."""
    return f"{one.status}: {one.why}" if one.why and one.status != "never measured" else one.why or one.status
