"""Which goals can be measured where their tunables stand, and what is told of those that can't."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace

from pico.model.goal import Goal
from pico.model.observation import Observation, ObservedValue
from pico.model.setup import Setup
from pico.model.state import LabState, is_reference, place_of
from pico.model.trace.expectation import GoalRead
from pico.model.vocabulary import measured_in
from pico.planning.goal_light import goal_light, kept_back
from pico.planning.measuring import granted, needed
from pico.planning.optimizing import Turn, live_number
from pico.planning.sought import Sought

NO_LIGHT = "no light comes through all that is tuned for it to where it is measured"


def readable(
    setup: Setup, seen: Observation, wanted: LabState, goals: Mapping[str, Goal],
    was: Mapping[str, Mapping[str, float]], measurables: Set[str],
) -> tuple[tuple[Turn, ...], tuple[GoalRead, ...]]:  # fmt: skip
    """Return the goals that can be measured, in the order along the beam, and those that can't: not met where no light
    comes there any more, else not assured. Those through whose parts none comes in the state that is `wanted`, either,
    are left alone. `was`: what was measured when each was met; `measurables`: the addresses of what the bench can
    measure."""
    turns: list[tuple[float, Turn]] = []
    told = []
    for name, goal in goals.items():
        light = goal_light(setup, seen, goal)
        if light.order is None and goal_light(setup, as_wanted(setup, seen, wanted), goal).order is None:
            continue
        if why := _unknown(setup, seen, goal, measurables) or _shut(setup, seen, goal, light.parts):
            told.append(GoalRead(goal=name, why=why))
        elif light.order is None:
            told.append(GoalRead(goal=name, met=False, why=NO_LIGHT))
        else:
            turns.append((light.order, Turn(Sought(name, goal, ""), verify=True, was=was.get(name))))
    return tuple(turn for _, turn in sorted(turns, key=lambda t: (t[0], t[1].one.name))), tuple(told)


def _shut(setup: Setup, seen: Observation, goal: Goal, parts: Set[str]) -> str:
    """Return what keeps the light of a goal back, which a measurement does not open; empty for nothing."""
    measured = ((c, setup.measurables_of(c)[name]) for c, name in measured_in(setup, goal.texts))
    wants = (need for c, measurable in measured for need in granted(setup, seen, needed(setup, seen, c, measurable)))
    return kept_back(setup, seen, parts, {need.address: need.value for need in wants} | dict(goal.during or {}))


def as_wanted(setup: Setup, seen: Observation, wanted: LabState) -> Observation:
    """Return the bench as it would be seen, were it as a state wants it."""
    found = {}
    for name, part in seen.components.items():
        if name in setup.lab.inventory:
            own = wanted.components.get(name)
            values = {t: ObservedValue(value=v) for t, v in (own.values if own else {}).items() if not is_reference(v)}
            pose = place_of(setup, wanted, name)[1]
            found[name] = replace(part, presence="seen", pose=pose, values={**part.values, **values})
    return replace(seen, components=found)


def _unknown(setup: Setup, seen: Observation, goal: Goal, measurables: Set[str]) -> str:
    """Return why nobody can measure a goal and leave all as it is; empty where somebody can."""
    for component, measurable in measured_in(setup, goal.texts):
        if f"{component}.{measurable}" not in measurables:
            return f"this bench can't measure {component}.{measurable}"
    looked = [address for settings in (goal.looks or {}).values() for address in settings]
    for address in goal.tunables:
        if live_number(seen, address) is None:
            return f"nobody knows {address}"
    for address in (*(goal.during or ()), *looked):
        component, _, tunable = address.partition(".")
        live = seen.components[component].values.get(tunable) if component in seen.components else None
        if live is None or live.status != "known":
            return f"nobody knows {address}, so that nobody could set it back"
    return ""
