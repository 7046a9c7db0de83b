"""What the simulated world does by itself: as large as it says, the same each time, and nothing where it is off."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from light_benches import kind, setup_of

from pico.model.pose import Pose
from pico.model.simulated import Environment, SimSettings
from pico.optics.environment import disturbed, in_the_world, temperature, wander
from pico.optics.light import light_of

AIR = Environment()


def test_what_wanders_has_the_deviation_that_it_says_at_any_time() -> None:
    drawn = np.array([wander(f"{seed}/x", 7.3e4, (300.0, 86400.0)) for seed in range(2000)])
    assert drawn.mean() == pytest.approx(0, abs=0.1) and drawn.std() == pytest.approx(1, rel=0.08)
    walked = np.array([wander("1/x", t, (0.01, 0.1)) for t in np.linspace(0, 50, 4000)])
    assert walked.std() == pytest.approx(1, rel=0.15)


def test_the_same_time_is_the_same_world_and_a_moment_later_nearly() -> None:
    assert disturbed(AIR, 1, "laser", 500.0) == disturbed(AIR, 1, "laser", 500.0)
    assert disturbed(AIR, 1, "laser", 500.0) != disturbed(AIR, 2, "laser", 500.0)
    now, soon = disturbed(AIR, 1, "laser", 5000.0), disturbed(AIR, 1, "laser", 5000.1)
    assert abs(now.left - soon.left) < 1e-4 and abs(now.moved - soon.moved) > 1e-9
    assert abs(temperature(AIR, 1, 5000.0)) < 2


def test_a_laser_comes_to_its_way_as_it_warms_up() -> None:
    only = Environment(temperature=0, pointing=0, power=0, vibration=0, warm_up=0.02)
    away = [np.hypot(d.left, d.up) for t in (0, 900, 9000) for d in [disturbed(only, 3, "laser", t)]]
    assert away == pytest.approx([0.02, 0.02 / np.e, 0.02 * np.exp(-10)])


@pytest.mark.parametrize("time", [0.0, 1234.0])
def test_the_beam_walks_in_the_focus_of_a_lens_by_its_focal_length_times_the_angle(time: float) -> None:
    kinds = {"laser": kind("hene_laser"), "lens": kind("plano_convex_100"), "cam": kind("beam_camera")}
    poses = {"laser": Pose(100, 420), "lens": Pose(400, 420), "cam": Pose(500, 420)}
    setup = setup_of(kinds)
    still = replace(setup, lab=replace(setup.lab, sim=SimSettings(environment="none")))
    assert in_the_world(still, poses, {}, 1, time) == (poses, {})
    moved = light_of(setup, *in_the_world(setup, poses, {}, 1, time))
    it = disturbed(AIR, 1, "laser", time)
    (arrival,) = moved.at("cam")
    assert arrival.center == pytest.approx((0.1 * it.left, 0.1 * it.up), abs=2e-6)
    (calm,) = light_of(still, poses, {}).at("cam")
    assert arrival.power == pytest.approx(calm.power * (1 + it.power))
