"""Which tunables a plan leaves where light has them, though a state gives them other numbers.

A tunable with `restore: align` that a goal of the lab tunes is driven to the number of a state only if the goal was met
with the numbers of the state in its layout, and was not met there with the live values. Pure: when goals were met is
passed in.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from pico.model.diff import deviation, value_deviation, value_distance
from pico.model.goal import Goal
from pico.model.observation import Aligned, Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.quantities import Value
from pico.model.setup import Setup
from pico.model.state import LabState, is_reference, place_of
from pico.planning.goal_light import goal_light
from pico.planning.verifying import as_wanted


@dataclass(frozen=True)
class GoalMet:
    """That a goal was met: `at` when (the wall, ISO 8601), the `values` of its tunables and numbers by address, and the
    `poses` of all parts then, by name."""

    goal: str
    at: str
    values: Mapping[str, float]
    poses: Mapping[str, Pose]

    def with_values(self, setup: Setup, values: Mapping[str, Value]) -> bool:
        """Return whether the goal was met with all of some values, by address, within their tolerances."""
        return all(a in self.values and equal(setup, a, self.values[a], value) for a, value in values.items())


def equal(setup: Setup, address: str, a: Value, b: Value) -> bool:
    """Return whether two values of a tunable are the same within its tolerance."""
    component, _, tunable = address.partition(".")
    kind = setup.type_of(component).tunables[tunable]
    return value_distance(kind, a, b) <= max(kind.tolerance, 1e-9)


def goals_by_tunable(setup: Setup) -> dict[str, tuple[str, ...]]:
    """Return by address the goals of the Lab that have the last word on a tunable with `restore: align`: the one that
    it names, else all that tune it. Tunables without any are left out: their numbers are all there is."""
    goals, found = setup.lab.goals or {}, dict[str, tuple[str, ...]]()
    for name in setup.lab.inventory if goals else ():
        for tunable, kind in setup.type_of(name).tunables.items():
            own, address = kind.restore.goal, f"{name}.{tunable}"
            if kind.restore.kind != "align":
                continue
            names = tuple(g for g, one in goals.items() if (g == own if own else address in one.tunables))
            if names:
                found[address] = names
    return found


def off_by_goal(setup: Setup, seen: Observation, wanted: LabState) -> dict[str, set[str]]:
    """Return by goal the tunables on which it has the last word and that are known to be off the numbers of a state."""
    found: dict[str, set[str]] = {}
    for address, goals in goals_by_tunable(setup).items():
        component, _, tunable = address.partition(".")
        state, live = wanted.components.get(component), seen.known_values.get(component, {}).get(tunable)
        number = state.values.get(tunable) if state else None
        if live is None or number is None or is_reference(number):
            continue
        if value_deviation(setup.type_of(component).tunables[tunable], live, number) == "off":
            for goal in goals:
                found.setdefault(goal, set()).add(address)
    return found


def left_to_light(
    setup: Setup, seen: Observation, wanted: LabState, met: Sequence[GoalMet], own: Collection[str]
) -> dict[str, Aligned]:
    """Return the tunables that stay at their live values, by address, each with the goal that has the last word.

    met: when goals of the Lab were met, the last one first. own: tunables whose live values no plan to a state set: a
    search, a person or a script did.
    """
    stay, driven = dict[str, Aligned](), set[str]()
    for name, addresses in off_by_goal(setup, seen, wanted).items():
        goal = (setup.lab.goals or {})[name]
        asked, live = _numbers(goal, addresses, wanted), _live(goal, addresses, seen)
        times = [one for one in met if one.goal == name]
        with_live = [one for one in times if one.with_values(setup, live)]
        with_asked = [one for one in times if one.with_values(setup, asked)]
        asked_there = with_asked and _in_layout(setup, seen, wanted, goal, with_asked)
        if asked_there and not _in_layout(setup, seen, wanted, goal, with_live):
            driven |= addresses
            continue
        at = with_live[0].at if with_live else ""
        stay |= {a: Aligned(goal=name, at=at) for a in sorted(addresses) if with_live or a in own}
    return {address: one for address, one in stay.items() if address not in driven}


def _numbers(goal: Goal, addresses: Collection[str], state: LabState) -> dict[str, Value]:
    """Return what a state gives the tunables of a goal, by address."""
    found: dict[str, Value] = {}
    for component, _, tunable in (a.partition(".") for a in {*goal.tunables, *addresses}):
        part = state.components.get(component)
        if part and tunable in part.values and not is_reference(part.values[tunable]):
            found[f"{component}.{tunable}"] = part.values[tunable]
    return found


def _live(goal: Goal, addresses: Collection[str], seen: Observation) -> dict[str, Value]:
    values, named = seen.known_values, {*goal.tunables, *addresses}
    live = {a: values.get(c, {}).get(t) for a in named for c, _, t in [a.partition(".")]}
    return {a: v for a, v in live.items() if v is not None}


def _in_layout(
    setup: Setup, seen: Observation, wanted: LabState, goal: Goal, times: Iterable[GoalMet]
) -> bool:  # fmt: skip
    """Return whether a goal was met once with every part in its light where a state wants it, within tolerance: parts
    in its light then, and in its light as the state has it."""
    parts: frozenset[str] | None = None
    for one in times:
        if parts is None:
            parts = goal_light(setup, as_wanted(setup, seen, wanted), goal).parts
        then = goal_light(setup, _as_it_was(setup, seen, one), goal).parts
        if all(_same_place(setup, name, one, wanted) for name in (parts | then) & setup.lab.inventory.keys()):
            return True
    return False


def _as_it_was(setup: Setup, seen: Observation, one: GoalMet) -> Observation:
    parts: dict[str, ObservedComponent] = {}
    for name, part in seen.components.items():
        if name not in setup.lab.inventory or name not in one.poses:
            continue
        given = {a.partition(".")[2]: v for a, v in one.values.items() if a.partition(".")[0] == name}
        known = {t: ObservedValue(value=v) for t, v in given.items() if t in part.values}
        parts[name] = replace(part, presence="seen", pose=one.poses[name], values={**part.values, **known})
    return replace(seen, components=parts)


def _same_place(setup: Setup, name: str, one: GoalMet, wanted: LabState) -> bool:
    slot, pose = place_of(setup, wanted, name)
    then = one.poses.get(name)
    return then is not None and deviation(setup, name, then, slot, pose) != "off"
