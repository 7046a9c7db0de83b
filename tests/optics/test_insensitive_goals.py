"""A goal that cannot work is told before anything is sought: what it measures does not follow what it tunes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from light_benches import kind, setup_of

from pico.model.goal import Goal
from pico.model.pose import Pose
from pico.optics.nominal.sensitivity import cautions

WAY = {"laser": Pose(100, 400), "h": Pose(300, 400), "p": Pose(500, 400), "pm": Pose(800, 400)}
NULL = Goal(tunables={"h.angle": (0.0, 180.0)}, minimize="pm.power")


def told(goal: Goal, kinds: Mapping[str, Any], values: Mapping[str, Any] | None = None) -> list[str]:
    own = {"laser": kind("hene_laser"), "pm": kind("power_meter"), **kinds}
    poses = {name: WAY[name] for name in own}
    return [one.summary for one in cautions(setup_of(own), poses, values or {}, goal)]


def test_a_wave_plate_without_a_polarizer_behind_it_changes_no_power() -> None:
    said = "no polarizer stands between h and pm: pm.power is the same at every h.angle"
    assert told(NULL, {"h": kind("half_wave_plate")}) == [said]
    assert told(NULL, {"h": kind("half_wave_plate"), "p": kind("mirror_flip")}, {"p": {"flipped": "down"}}) == [said]


@pytest.mark.parametrize("analyzer", ["linear_polarizer", "polarizing_beam_splitter", "faraday_isolator"])
def test_with_something_that_takes_polarization_it_does(analyzer: str) -> None:
    assert told(NULL, {"h": kind("half_wave_plate"), "p": kind(analyzer)}) == []


def test_a_polarizer_after_a_polarized_laser_changes_power() -> None:
    assert told(NULL, {"h": kind("linear_polarizer")}) == []


def test_a_plate_before_light_that_has_no_polarization_left_is_told_otherwise() -> None:
    """There is a polarizer, and the plate turns nothing: circular light through a half-wave plate stays circular."""
    kinds = {
        "laser": kind("hene_laser", polarization_ratio=1.0),
        "h": kind("half_wave_plate"),
        "p": kind("linear_polarizer"),
    }
    assert told(NULL, kinds) == ["pm.power does not change with h.angle from 0 to 180 deg"]


def test_a_stage_of_a_lens_moves_the_spot_and_not_the_power_of_a_large_meter() -> None:
    lens = {"h": kind("lens_xyz_stage")}
    goal = Goal(tunables={"h.stage_y": (-0.2, 0.2)}, maximize="pm.power")
    assert told(goal, lens) == ["pm.power does not change with h.stage_y from -0.2 to 0.2 mm"]
    camera = {**lens, "pm": kind("beam_camera")}
    assert told(Goal(tunables={"h.stage_y": (-0.2, 0.2)}, reach={"pm.centroid.x": 0.0}), camera) == []


def test_a_tunable_that_stands_outside_of_where_it_is_searched_is_told() -> None:
    goal = Goal(tunables={"h.stage_y": (-0.2, 0.2)}, reach={"pm.centroid.x": 0.0})
    own = {"h": kind("lens_xyz_stage"), "pm": kind("beam_camera")}
    assert told(goal, own, {"h": {"stage_y": 0.7}}) == ["h.stage_y is at 0.7 mm, and only -0.2 to 0.2 is searched"]
    assert told(goal, own, {"h": {"stage_y": 0.1}}) == []
    assert told(NULL, {"h": kind("half_wave_plate"), "p": kind("linear_polarizer")}, {"h": {"angle": 350.0}}) == []


def test_nothing_is_said_of_what_the_model_cannot_tell() -> None:
    looks = Goal(tunables={"h.angle": (0.0, 180.0)}, minimize="a.pm.power", looks={"a": {"laser.shutter": "open"}})
    assert told(looks, {"h": kind("half_wave_plate")}) == []
    own = {"laser": kind("hene_laser"), "h": kind("half_wave_plate"), "pm": kind("power_meter")}
    beside = {**{name: WAY[name] for name in own}, "pm": Pose(800, 700)}
    assert cautions(setup_of(own), beside, {}, NULL) == ()
