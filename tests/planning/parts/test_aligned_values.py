"""Which tunables a plan leaves where light has them: as data, on the fiber bench."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.manifest.load import load_folder
from pico.model.observation import Aligned, Observation, ObservedComponent, ObservedValue
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import LabState, place_of, with_values
from pico.planning import PlanGoal, Planner
from pico.planning.aligned_values import GoalMet, goals_by_tunable, left_to_light

LAB = Path(__file__).resolve().parents[2] / "labs" / "fiber"
FOUND = {"m1.tip": 2.9, "m1.tilt": 0.06, "m2.tip": 1.9, "m2.tilt": -0.27}
OTHER = {"m1.tip": -1.1, "m1.tilt": 0.8, "m2.tip": -0.4, "m2.tilt": -1.2}
AT = "2026-11-27T07:00:00+00:00"


@cache
def bench() -> tuple[Setup, LabState]:
    setup, state = load_folder(LAB).require()
    return setup, state


def seen(state: LabState, values: Mapping[str, float]) -> Observation:
    """Return the bench as it stands when it is as a state, and its mirrors at some values."""
    setup, wanted = bench()[0], with_values(state, values)
    parts = {}
    for name in setup.lab.inventory:
        own = wanted.components.get(name)
        known = {t: ObservedValue(value=v) for t, v in (own.values if own else {}).items()}
        parts[name] = ObservedComponent(pose=place_of(setup, wanted, name)[1], values=known)
    return Observation(backend="sim", components=parts)


def met(values: Mapping[str, float], state: LabState) -> GoalMet:
    setup = bench()[0]
    poses = {name: place_of(setup, state, name)[1] for name in setup.lab.inventory}
    return GoalMet("coupling", AT, {**values, "fc.power": 1.2}, poses)


def moved(state: LabState, name: str, dx: float) -> LabState:
    pose = state.components[name].pose
    assert pose is not None
    part = replace(state.components[name], pose=Pose(pose.x + dx, pose.y, pose.yaw))
    return replace(state, components={**state.components, name: part})


def left(live: Mapping[str, float], wanted: LabState, times: list[GoalMet], own: bool = True) -> dict[str, Aligned]:
    return left_to_light(bench()[0], seen(wanted, live), wanted, times, set(FOUND) if own else set())


def test_the_last_word_is_the_goals_that_tunes_it() -> None:
    assert goals_by_tunable(bench()[0]) == dict.fromkeys(FOUND, ("coupling",))


def test_what_was_met_stays_whatever_a_state_says_that_was_never_met() -> None:
    state = bench()[1]
    kept = left(FOUND, state, [met(FOUND, state)])
    assert kept.keys() == FOUND.keys()
    assert all(one == Aligned(goal="coupling", at=AT) for one in kept.values())


def test_a_state_that_was_met_in_its_layout_has_its_numbers_unless_the_live_ones_were_met_there_too() -> None:
    state = with_values(bench()[1], OTHER)
    apart = met(FOUND, moved(state, "l2", 20))
    assert left(FOUND, state, [apart, met(OTHER, state)]) == {}, "met there, and the live values were met elsewhere"
    assert left(FOUND, state, [met(FOUND, state), met(OTHER, state)]).keys() == FOUND.keys(), "both were met there"
    assert left(FOUND, state, [apart, met(OTHER, moved(state, "l2", 20))]).keys() == FOUND.keys(), "met elsewhere only"
    beside = met(OTHER, moved(state, "block", 5)) if state.components.get("block") else met(OTHER, state)
    assert left(FOUND, state, [apart, beside]) == {}, "a part beside the beam is no matter"


def test_values_are_met_together_or_not_at_all() -> None:
    state = with_values(bench()[1], OTHER)
    mixed = {**OTHER, "m2.tip": 1.9}
    assert left(FOUND, state, [met(mixed, state)]).keys() == FOUND.keys()


def test_what_only_plans_set_and_no_goal_was_met_with_is_a_set_point() -> None:
    state = with_values(bench()[1], OTHER)
    assert left(FOUND, state, [], own=False) == {}
    kept = left(FOUND, state, [], own=True)
    assert kept.keys() == FOUND.keys() and all(one.at == "" for one in kept.values())


@pytest.mark.parametrize("exact", [False, True])
def test_a_plan_drives_nothing_that_stays_unless_exact(exact: bool) -> None:
    setup, state = bench()
    wanted = with_values(state, {"qwp.angle": 30.0})
    live = replace(seen(state, FOUND), aligned=left(FOUND, wanted, [met(FOUND, state)]))
    plan = Planner(setup, None, live).plan(PlanGoal(wanted, exact=exact))
    driven = {f"{op.component}.{op.arguments.get('tunable')}" for op in plan.operations if op.primitive == "set"}
    assert driven - {"laser.shutter"} == {"qwp.angle"} | (set(FOUND) if exact else set())
    assert plan.reached is False


@settings(max_examples=30)
@given(
    live=st.fixed_dictionaries(dict.fromkeys(FOUND, st.floats(-1.5, 1.5))),
    number=st.fixed_dictionaries(dict.fromkeys(FOUND, st.floats(-1.5, 1.5))),
    where=st.lists(st.sampled_from(["live here", "live there", "number here", "number there"]), unique=True),
)
def test_no_alignment_is_driven_away_but_for_one_that_was_met_there(
    live: dict[str, float], number: dict[str, float], where: list[str]
) -> None:
    state = with_values(bench()[1], number)
    layouts = {"here": state, "there": moved(state, "l2", 20)}
    times = [met({"live": live, "number": number}[w.split()[0]], layouts[w.split()[1]]) for w in where]
    kept = left(live, state, times)
    same = all(abs(live[a] - number[a]) <= 0.05 for a in live)
    number_here = "number here" in where or ("live here" in where and same)
    live_here = "live here" in where or ("number here" in where and same)
    off = {a for a in live if abs(live[a] - number[a]) > 0.05}
    assert kept.keys() == (set() if number_here and not live_here else off)
