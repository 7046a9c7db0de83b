"""Steps: bounded by what is over in time, within the range, chosen from a ladder."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.model.catalog import Axis, Tunable
from pico.model.pose import Pose
from pico.teleop.frames import STEP_SECONDS
from pico.teleop.steps import Jogged, ladder, moved, of


@given(st.floats(1e-3, 1e3))
def test_an_axis_goes_no_farther_in_a_step_than_it_can_in_time(speed: float) -> None:
    assert of(Tunable(axis=Axis(speed=speed), range=(-1e6, 1e6))).longest / speed <= STEP_SECONDS * (1 + 1e-12)


@given(st.floats(-3, 3), st.floats(-2, 2))
def test_a_step_ends_within_the_range_and_never_leads_away_from_it(here: float, by: float) -> None:
    found = Jogged(unit="mm", longest=2.0, range=(-2.0, 2.0)).after(here, by)
    assert min(-2.0, here) <= found <= max(2.0, here)
    assert abs(found - here) <= abs(by) + 1e-12


def test_a_period_closes() -> None:
    assert Jogged(unit="deg", longest=9.0, period=180.0).after(178.0, 5.0) == pytest.approx(3.0)


@given(st.floats(1e-4, 1e4))
def test_a_ladder_goes_up_to_the_longest_step(longest: float) -> None:
    rungs = ladder(longest)
    assert rungs == sorted(rungs) and rungs[0] > 0 and rungs[-1] <= longest * (1 + 1e-9)
    assert len(rungs) == 1 or longest / rungs[-1] < 2.5 + 1e-9
    assert all(math.isclose(b / a, 2.0, rel_tol=0.3) for a, b in pairwise(rungs))


def test_a_step_changes_one_of_x_y_and_yaw() -> None:
    assert moved(Pose(1, 2, 3), "x", 0.5) == Pose(1.5, 2, 3)
    assert moved(Pose(1, 2, 3), "yaw", -4) == Pose(1, 2, -1)
