"""Which goal a set-point is that light finds: what is tuned, where it is measured, and why where no light comes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from pico.manifest.load import load_folder
from pico.model.lab import Goal
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.state import LightReference
from pico.planning.by_light import reference_goals
from pico.planning.goal_light import goal_light
from pico.resources import labs_dir

SETUP = load_folder(labs_dir() / "shel").require()[0]
NULL = {"p2.angle": LightReference(null_of=("p1", "p2"), offset=1.0)}
PLACES = {
    "laser": Pose(120, 420, 0), "p1": Pose(290, 420, 0), "p2": Pose(520, 420, 0), "cam": Pose(1060, 420, 0),
}  # fmt: skip


def test_a_null_is_sought_by_its_own_tunable_on_the_detector_behind_both() -> None:
    goal = reference_goals(SETUP, NULL, PLACES, {}).goals["p2.angle"]
    assert goal.tunables == {"p2.angle": (0.0, 360.0)} and goal.minimize == "cam.power" and goal.offset == 1.0
    assert goal.parameters == {"within": pytest.approx(0.02)} and goal.description == "1° from the null of p1 and p2"


def test_the_order_in_which_both_are_named_makes_no_other_goal() -> None:
    other = {"p2.angle": LightReference(null_of=("p2", "p1"), offset=1.0)}
    goals = [replace(reference_goals(SETUP, r, PLACES, {}).goals["p2.angle"], description="") for r in (NULL, other)]
    assert goals[0] == goals[1]


def test_what_stands_behind_the_last_polarizer_does_not_turn_a_null() -> None:
    places = {**PLACES, "lx_125": Pose(395, 420, 0), "ly_150": Pose(670, 420, 0)}
    seen = Observation(backend="sim", components={name: ObservedComponent(pose=pose) for name, pose in places.items()})
    goal = reference_goals(SETUP, NULL, places, {}).goals["p2.angle"]
    light = goal_light(SETUP, seen, goal)
    assert light.beyond == {"ly_150"} and {"lx_125", "p1", "ly_150"} <= light.parts
    assert goal_light(SETUP, seen, replace(goal, tunables={"ly_150.stage_y": (-1, 1)})).beyond == set()
    centred = Goal(tunables=goal.tunables, reach={"cam.centroid.x": 0.0}, tolerance=5)
    assert goal_light(SETUP, seen, centred).beyond == set(), "a lens moves a spot"


def test_a_part_that_no_light_comes_through_is_named() -> None:
    found = reference_goals(SETUP, NULL, {**PLACES, "p1": Pose(290, 300, 0)}, {})
    assert not found.goals
    assert "no light comes through p1 to a detector" in found.wrong[0].summary and found.wrong[0].address == "p2.angle"


def test_without_a_detector_behind_there_is_no_goal() -> None:
    before = {**PLACES, "cam": Pose(400, 420, 0)}  # p2 stands behind it
    found = reference_goals(SETUP, NULL, before, {})
    assert not found.goals and "no light comes through p2 to a detector" in found.wrong[0].summary
    none = {name: pose for name, pose in PLACES.items() if name != "cam"}
    assert "no light comes through p1 and p2" in reference_goals(SETUP, NULL, none, {}).wrong[0].summary
