"""Which goal a set-point is that light finds: what is tuned, where it is measured, and why where no light comes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import pytest

from pico.manifest.load import load_files, load_folder
from pico.model.goal import Goal
from pico.model.observation import Observation, ObservedComponent
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.model.state import ComponentState, LabState, LightReference, goals_of
from pico.planning.by_light import ByLight, reference_goals
from pico.planning.goal_light import goal_light
from pico.resources import labs_dir

SETUP = load_folder(labs_dir() / "shel").require()[0]
NULL = {"p2.angle": LightReference(null_of=("p1", "p2"), offset=1.0)}
PLACES = {
    "laser": Pose(120, 420, 0), "p1": Pose(290, 420, 0), "p2": Pose(520, 420, 0), "cam": Pose(1060, 420, 0),
}  # fmt: skip


def found(
    references: Mapping[str, LightReference], places: Mapping[str, Pose], setup: Setup = SETUP,
    meant: Mapping[str, Pose] | None = None,
) -> ByLight:  # fmt: skip
    parts = {name: ObservedComponent(pose=pose) for name, pose in places.items()}
    named: dict[str, dict[str, LightReference]] = {}
    for address, one in references.items():
        component, _, tunable = address.partition(".")
        named.setdefault(component, {})[tunable] = one
    state = LabState(lab="lab", components={name: ComponentState(by_light=own) for name, own in named.items()})
    seen = Observation(backend="sim", components=parts)
    meant_parts = {name: ObservedComponent(pose=(meant or places)[name]) for name in places}
    return reference_goals(setup, goals_of(state), seen, replace(seen, components=meant_parts))


def test_a_null_is_sought_by_its_own_tunable_on_the_detector_behind_both() -> None:
    goal = found(NULL, PLACES).goals["p2.angle"]
    assert goal.tunables == {"p2.angle": (0.0, 360.0)} and goal.minimize == "cam.power" and goal.offset == 1.0
    assert goal.parameters == {"within": pytest.approx(0.02)} and goal.description == "1° from the null of p1 and p2"


def test_the_order_in_which_both_are_named_makes_no_other_goal() -> None:
    other = {"p2.angle": LightReference(null_of=("p2", "p1"), offset=1.0)}
    goals = [replace(found(r, PLACES).goals["p2.angle"], description="") for r in (NULL, other)]
    assert goals[0] == goals[1]


def test_what_stands_behind_the_last_polarizer_does_not_turn_a_null() -> None:
    places = {**PLACES, "lx_125": Pose(395, 420, 0), "ly_150": Pose(670, 420, 0)}
    seen = Observation(backend="sim", components={name: ObservedComponent(pose=pose) for name, pose in places.items()})
    goal = found(NULL, places).goals["p2.angle"]
    light = goal_light(SETUP, seen, goal)
    assert light.beyond == {"ly_150"} and {"lx_125", "p1", "ly_150"} <= light.parts
    assert goal_light(SETUP, seen, replace(goal, tunables={"ly_150.stage_y": (-1, 1)})).beyond == set()
    centred = Goal(tunables=goal.tunables, reach={"cam.centroid.x": 0.0}, tolerance=5)
    assert goal_light(SETUP, seen, centred).beyond == set(), "a lens moves a spot"


def test_a_part_that_no_light_comes_through_is_named() -> None:
    lost = found(NULL, {**PLACES, "p1": Pose(290, 300, 0)})
    assert not lost.goals
    wrong = lost.wrong["p2.angle"]
    assert "no light comes through p1 to a detector" in wrong.summary and wrong.address == "p2.angle"


def test_without_a_detector_behind_there_is_no_goal() -> None:
    before = {**PLACES, "cam": Pose(400, 420, 0)}  # p2 stands behind it
    lost = found(NULL, before)
    assert not lost.goals and "no light comes through p2 to a detector" in lost.wrong["p2.angle"].summary
    none = {name: pose for name, pose in PLACES.items() if name != "cam"}
    assert "no light comes through p1 and p2" in found(NULL, none).wrong["p2.angle"].summary


TWO_MIRRORS = load_files(
    {
        "lab.yaml": b"""\
apiVersion: pico/v1
kind: Lab
metadata: {name: irises}
table: {size: [1500, 900], beam_height: 70}
robots: {arm1: {model: xarm7, mount: {x: 750, y: 850, yaw: -90}}}
inventory:
  laser: {type: hene_laser_expanded, pose: {x: 120, y: 260, yaw: 0}}
  m1: {type: mirror_tip_tilt, pose: {x: 400, y: 260, yaw: -45}}
  m2: {type: mirror_tip_tilt, pose: {x: 400, y: 440, yaw: 135}}
  m3: {type: mirror_tip_tilt, pose: {x: 700, y: 700, yaw: 0}}
  near: {type: iris, pose: {x: 560, y: 440, yaw: 0}}
  far: {type: iris, pose: {x: 1000, y: 440, yaw: 0}}
  meter: {type: power_meter, pose: {x: 1200, y: 440, yaw: 0}}
"""
    }
).setup
THROUGH = "through far near"


def through(*addresses: str, **at: Pose) -> ByLight:
    assert TWO_MIRRORS is not None
    meant = {name: part.pose for name, part in TWO_MIRRORS.lab.inventory.items() if part.pose}
    references = {address: LightReference(through=("near", "far")) for address in addresses}
    near = {name: place.distance(meant[name]) < 1 for name, place in at.items()}
    return found(references, meant | at, TWO_MIRRORS, {n: meant[n] if near.get(n, True) else at[n] for n in meant})


def aim_of(by_light: ByLight) -> Mapping[str, float]:
    return by_light.ready[THROUGH].aim or {}


def test_all_that_bring_a_beam_through_the_same_irises_are_one_goal() -> None:
    by_light = through("m2.tilt", "m1.tip", "m1.tilt", "m2.tip")
    goal = by_light.goals[THROUGH]
    assert [*by_light.goals] == [THROUGH] and not by_light.wrong
    assert [*goal.tunables] == ["m1.tilt", "m1.tip", "m2.tilt", "m2.tip"], "in the order in which light comes to them"
    assert goal.maximize == "at_near.meter.power * at_far.meter.power"
    assert goal.description == "through near and far"
    ((label, first),) = by_light.ready[THROUGH].first
    assert label == "light behind near" and first.tunables.keys() == {"m1.tip", "m1.tilt"}
    assert [*through("m2.tip", "m2.tilt").goals[THROUGH].tunables] == ["m2.tilt", "m2.tip"]


def test_the_order_in_which_irises_are_named_makes_no_other_goal() -> None:
    one, other = LightReference(through=("near", "far")), LightReference(through=("far", "near"))
    parts = {"m1": ComponentState(by_light={"tip": one}), "m2": ComponentState(by_light={"tip": other})}
    state = LabState(lab="irises", components=parts)
    assert [*goals_of(state)] == [THROUGH]


def test_mirrors_are_searched_about_where_the_nominal_beam_goes_through_both() -> None:
    straight = through("m1.tip", "m1.tilt", "m2.tip", "m2.tilt")
    assert all(abs(aim) < 1e-6 for aim in aim_of(straight).values())
    turned = through("m1.tip", "m1.tilt", "m2.tip", "m2.tilt", m1=Pose(400, 260, -45.3))
    aim = aim_of(turned)["m1.tip"]
    low, high = turned.goals[THROUGH].tunables["m1.tip"]
    assert abs(aim) == pytest.approx(5.24, abs=0.05), "0.3 deg"
    assert low < aim < high and high - low < 20


def test_what_can_not_bring_the_beam_there_is_named() -> None:
    assert "no light comes from m3 to near" in through("m3.tip", "m1.tip").wrong[THROUGH].summary
    lost = through("m1.tip", "m2.tip", far=Pose(1000, 600, 0)).wrong[THROUGH]
    assert "m1.tip, m2.tip can't be found by light: no beam comes through near to far" in lost.summary
    dark = through("m1.tip", "m2.tip", meter=Pose(1200, 700, 0)).wrong[THROUGH]
    assert "nothing behind far measures light" in dark.summary and dark.address == "m1.tip"
