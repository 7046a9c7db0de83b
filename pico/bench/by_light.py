"""Set-points that light finds, on one bench: goals beside those of its Lab, and equal to it while they are aligned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pico.bench.aligned import stands
from pico.model.diff import Change
from pico.model.observation import Observation
from pico.model.setup import Setup
from pico.model.state import LabState, goals_of, references_of
from pico.planning.alignment import standing_text

if TYPE_CHECKING:
    from pico.runs.memory import Memory


def unaligned(setup: Setup, memory: Memory | None, seen: Observation, state: LabState) -> dict[str, str]:
    """Return the references of a state that are not equal to the bench by their address, each with the reason."""
    goals = goals_of(state)
    if not goals:
        return {}
    off = [one for one in stands(setup, memory, seen, state) if one.status != "aligned"]
    return {address: standing_text(one) for one in off for address in goals.get(one.goal, ())}


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
