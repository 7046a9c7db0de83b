"""A ruler measures between what its words name: points, faces, and along a beam."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from physical import bench

from pico.diagnostics import PicoError
from pico.drawing.picture import placed
from pico.drawing.ruler import end_of, measure
from pico.geometry.shape import placed as shape_at
from pico.geometry.shape import separation
from pico.model.pose import Pose
from pico.model.setup import Setup

POSES = {"lx_125": Pose(395, 420, 0), "ly_150": Pose(670, 420, 0), "p2": Pose(520, 300, 30)}
coordinate = st.floats(100, 800)


@pytest.fixture(scope="module")
def setup() -> Setup:
    return bench()


def test_two_lenses_on_a_beam(setup: Setup) -> None:
    found = measure(setup, POSES, {}, "lx_125", "ly_150")
    assert found.centers.delta == pytest.approx((275, 0, 0))
    assert found.surfaces is not None and found.beam is not None
    assert found.surfaces.gap == pytest.approx(215)  # bases of 60 mm
    assert (found.surfaces.a, found.surfaces.b) == ("base", "base")
    assert (found.beam.ahead, found.beam.left, found.beam.above) == pytest.approx((275, 0, 0))


@given(x=coordinate, y=coordinate, yaw=st.floats(-180, 180))
def test_faces_are_as_far_apart_as_footprints_where_the_bases_are_the_nearest(x: float, y: float, yaw: float) -> None:
    setup = bench()
    poses = {"lx_125": Pose(900, 800, 0), "ly_150": Pose(x, y, yaw)}
    found = measure(setup, poses, {}, "lx_125", "ly_150")
    prints = [shape_at(setup.type_of(n).geometry.footprint, p) for n, p in poses.items()]
    gap = separation(*prints)
    assert found.surfaces is not None
    if gap > 1:
        assert found.surfaces.gap <= gap + 1e-3
        assert found.surfaces.gap == pytest.approx(gap, abs=2.0)
        assert found.surfaces.span.length == pytest.approx(found.surfaces.gap, abs=1e-3)


@given(x=coordinate, y=coordinate, yaw=st.floats(-180, 180))
def test_along_the_axis_and_across_it_make_up_the_distance(x: float, y: float, yaw: float) -> None:
    found = measure(bench(), {"p2": Pose(x, y, yaw)}, {}, "p2", "500,400")
    beam = found.beam
    assert beam is not None and found.surfaces is None
    assert math.hypot(beam.ahead, beam.left, beam.above) == pytest.approx(found.centers.length)
    ahead = Pose(*found.a.at[:2], yaw).apply(beam.ahead, beam.left)
    assert ahead == pytest.approx((500, 400), abs=1e-6)


def test_words_name_holes_slots_and_points_of_a_component(setup: Setup) -> None:
    places = placed(POSES)
    assert end_of(setup, places, "hole:1,1").at == (12.5, 12.5, 0)
    assert end_of(setup, places, "hole:12,7").at == (287.5, 162.5, 0)
    assert end_of(setup, places, "storage/a1").at == (110, 310, 0)
    assert end_of(setup, places, "520,-4.5").at == (520, -4.5, 0)
    assert end_of(setup, places, "p2:base").at == pytest.approx((520, 300, 0))
    assert end_of(setup, places, "p2").at[2] == pytest.approx(70)
    assert end_of(setup, places, "p2:hole").at == (512.5, 287.5, 0) or end_of(setup, places, "p2:hole").at == (
        512.5, 312.5, 0,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("p3", "neither a component nor a slot"), ("p2:bse", "base"), ("hole:99,1", "48 columns and 36 rows"),
        ("hole:1.5,2", "COLUMN,ROW"), ("hole:0,1", "counted from 1"), ("1,2,3,4", "x,y"), ("cam", "not on the table"),
    ],
)  # fmt: skip
def test_what_is_not_there_is_refused_with_what_would_be_right(setup: Setup, word: str, said: str) -> None:
    with pytest.raises(PicoError) as refused:
        measure(setup, POSES, {}, word, "p2")
    (problem,) = refused.value.diagnostics
    assert said in f"{problem.summary} {problem.hint}"
