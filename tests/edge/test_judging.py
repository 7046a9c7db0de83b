"""Whether a goal is met where its tunables stand, by one reading of it."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.edge.judging import SHARE, SURE, judged
from pico.optimize.loop import Limits, Reading
from pico.optimize.problem import Problem, Variable

AXIS = (Variable("l.y", -1.0, 1.0, 0.25),)
LIMITS = Limits(measurements=10, seconds=10.0)
CENTRED = Problem(AXIS, ("c.x", "c.y"), "reach", {"c.x": 1.0}, {"c.x": 5.0, "c.y": 5.0})


def objective(aim: str, offset: float | None = None, tolerance: float = 0.0) -> Problem:
    near = {"objective": tolerance}
    return Problem(AXIS, ("objective",), aim, tolerance=near, offset=None if offset is None else {"l.y": offset})  # type: ignore[arg-type]


def read(**values: float) -> Reading:
    return Reading({name.replace("_at_", "."): value for name, value in values.items()})


@given(st.floats(-50, 50), st.floats(0.01, 3))
def test_what_is_to_be_reached_is_lost_where_it_is_off_by_more_than_tolerance_and_noise(
    off: float, sigma: float
) -> None:
    reading = Reading({"c.x": 1.0 + off, "c.x_sigma": sigma, "c.y": 0.0, "c.y_sigma": sigma})
    found = judged(CENTRED, LIMITS, reading, "", None)
    assert found["met"] is (abs(reading.values["c.x"] - 1.0) <= 5.0 + SURE * sigma)
    assert ("c.x is" in found["why"]) is not found["met"] and "c.y" not in found["why"]
    assert found["last"]["l.y"] == 0.25 and found["last"]["c.x"] == reading.values["c.x"]


@pytest.mark.parametrize(("aim", "better"), [("maximize", 1), ("minimize", -1)])
def test_what_is_to_be_best_is_compared_with_what_it_was_and_may_be_better(aim: str, better: int) -> None:
    was = {"objective": 1000.0, "objective_sigma": 1.0}
    near = SURE * math.hypot(1.0, 1.0, SHARE * 1000)
    for by, met in ((0.0, True), (10 * near, True), (-0.99 * near, True), (-1.01 * near, False)):
        now = Reading({"objective": 1000.0 + better * by, "objective_sigma": 1.0})
        if now.values["objective"] > 3:  # else there is no light
            assert judged(objective(aim), LIMITS, now, "", was)["met"] is met, by


def test_left_beside_the_best_it_may_not_be_better_either() -> None:
    was, much = {"objective": 1000.0, "objective_sigma": 1.0}, {"objective": 500.0, "objective_sigma": 1.0}
    assert judged(objective("minimize"), LIMITS, Reading(much), "", was)["met"]
    found = judged(objective("minimize", offset=1.0), LIMITS, Reading(much), "", was)
    assert not found["met"] and found["why"] == "it is 500, and was 1000"


def test_without_light_it_is_lost_and_what_is_not_assured_is_told_as_such() -> None:
    dark = judged(CENTRED, LIMITS, Reading(unknown="nothing above the background"), "", None)
    assert dark == {"met": False, "why": "no light: nothing above the background", "last": {"l.y": 0.25}}
    lost = judged(CENTRED, LIMITS, Reading({"c.x": 1.0, "c.y": 0.0}), "a frame was lost", None)
    assert lost == {"doubt": "a frame was lost", "last": {"l.y": 0.25}}, "nothing of it is believed"
    never = judged(objective("maximize"), LIMITS, Reading({"objective": 9.0, "objective_sigma": 0.1}), "", None)
    assert "met" not in never and "how it was" in never["doubt"] and never["last"]["objective"] == 9.0
