"""Quantities: nulls by the law of Malus, peaks, shares."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.diagnosis.quantities import Quantity, Shot, quantity


def scan(law: str, points: list[float], harmonic: int = 2) -> Quantity:
    shots = tuple(Shot("cam.power", {"p1.angle": p}) for p in points)
    return Quantity("q", shots, "power", law, "deg", "p1.angle", harmonic)  # type: ignore[arg-type]


@given(
    null=st.floats(-3, 3), depth=st.floats(1e-5, 1e-2), bright=st.floats(1e-3, 1e6), harmonic=st.sampled_from((2, 4))
)
def test_a_null_is_found_where_the_law_of_malus_has_it(null: float, depth: float, bright: float, harmonic: int) -> None:
    points = [88.0, 90.0, 92.0]
    values = [bright * (depth + math.sin(math.radians(harmonic / 2 * (p - 90 - null))) ** 2) for p in points]
    found = quantity(scan("null", points, harmonic), [(v, 1e-4 * v) for v in values])
    assert found is not None and found.value == pytest.approx(90 + null, abs=1e-5)
    low = quantity(scan("depth", points, harmonic), [(v, 1e-4 * v) for v in values])
    assert low is not None and low.value == pytest.approx(math.log(bright * depth), abs=max(0.01, 4 * low.sigma))


@given(middle=st.floats(-0.5, 0.5), width=st.floats(0.5, 3.0))
def test_a_peak_is_found_by_the_parabola_through_its_logarithm(middle: float, width: float) -> None:
    points = [-1.0, 0.0, 1.0]
    found = quantity(scan("peak", points), [(math.exp(-(((p - middle) / width) ** 2)), 1e-6) for p in points])
    assert found is not None and found.value == pytest.approx(middle, abs=1e-9)


def test_what_does_not_tell_is_nothing() -> None:
    flat = [(1.0, 0.001)] * 3
    assert quantity(scan("null", [88.0, 90.0, 92.0]), flat) is None
    assert quantity(scan("peak", [-1.0, 0.0, 1.0]), flat) is None
    assert quantity(Quantity("q", (Shot("cam.power"),), "power", "share"), [(0.0, 0.0)]) is None


def test_a_share_in_the_dark_is_no_more_than_its_noise() -> None:
    found = quantity(Quantity("q", (Shot("pd.voltage"),), "voltage", "share"), [(-0.05, 0.1)])
    assert (
        found is not None
        and found.value == pytest.approx(math.log(0.2))
        and found.sigma == pytest.approx(0.5, abs=0.01)
    )
    assert quantity(Quantity("q", (Shot("cam.power"),), "power", "share"), []) is None
    assert quantity(Quantity("q", (Shot("cam.power"),), "power"), [(math.nan, 0.1)]) is None
