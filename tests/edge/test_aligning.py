"""Optimizations at the edge: axes come from their side, within their range."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.edge.aligning import ways
from pico.model.catalog import Axis, Tunable


def axis(approach: str, backlash: float = 0.01) -> Tunable:
    return Tunable(range=(-1.0, 1.0), axis=Axis(speed=1.0, backlash=backlash, approach=approach))  # type: ignore[arg-type]


@given(
    st.floats(-1, 1),
    st.floats(-1, 1),
    st.sampled_from(["positive", "negative", "either"]),
    st.sampled_from([0.0, 1e-4, 0.01, 0.1]),
)
def test_the_last_way_to_a_value_is_from_the_side_of_the_axis(
    here: float, goal: float, approach: str, backlash: float
) -> None:
    found = ways(axis(approach, backlash), here, goal, (-1.0, 1.0))
    assert all(-1 <= value <= 1 for value in found) and len(found) <= 2
    if here == goal:
        assert not found
        return
    assert found[-1] == goal
    before = found[-2] if len(found) > 1 else here
    at_end = goal in (-1.0, 1.0)
    if approach != "either" and backlash > 0 and not at_end and before != goal:
        assert (goal > before) is (approach == "positive")


def test_what_has_no_axis_goes_straight() -> None:
    assert ways(Tunable(range=(0.0, 5.0)), 1.0, 3.0, (0.0, 5.0)) == (3.0,)
    assert ways(axis("positive"), 0.5, 0.2, (-1, 1)) == pytest.approx((0.18, 0.2))
    assert ways(axis("positive"), 0.1, 0.2, (-1, 1)) == (0.2,)
