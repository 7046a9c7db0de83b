"""Signed distances of footprints, against shapely and by their own laws."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point, Polygon

from pico.geometry import Shape, conflict, disc, half_turn_symmetric, moved, placed, rectangle, separation
from pico.model.catalog import Footprint
from pico.model.pose import Pose

coordinates = st.floats(-150, 150)
poses = st.builds(Pose, coordinates, coordinates, st.floats(-180, 180))
boxes = st.builds(lambda a, b: Footprint(box=(a, b)), st.floats(1, 120), st.floats(1, 120))
discs = st.builds(lambda r: Footprint(disc=r), st.floats(1, 60))
regular = st.builds(
    lambda n, r: Footprint(
        polygon=tuple((r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n)) for i in range(n))
    ),
    st.integers(3, 8),
    st.floats(5, 60),
)
shapes = st.builds(placed, st.one_of(boxes, discs, regular), poses)


def shapely_gap(a: Shape, b: Shape) -> float:
    """The distance by shapely; discs as points with a radius. At most zero where they overlap."""
    cores = [Polygon(s.vertices) if s.vertices else Point(s.x, s.y) for s in (a, b)]
    return cores[0].distance(cores[1]) - sum(s.radius for s in (a, b) if not s.vertices)


@given(shapes, shapes)
def test_separation_is_the_distance_that_shapely_finds(a: Shape, b: Shape) -> None:
    expected = shapely_gap(a, b)
    if expected > 1e-6:
        assert separation(a, b) == pytest.approx(expected, abs=1e-6)
    else:
        assert separation(a, b) <= 1e-6


@given(shapes, shapes, st.floats(0, 20))
def test_it_is_symmetric(a: Shape, b: Shape, margin: float) -> None:
    assert separation(a, b) == separation(b, a)
    assert conflict(a, b, margin) == conflict(b, a, margin)


@given(shapes, shapes, st.floats(0, 2 * math.pi))
def test_a_shift_by_less_than_the_depth_never_parts_two_shapes(a: Shape, b: Shape, angle: float) -> None:
    depth = -separation(a, b)
    if depth > 1e-6:
        shift = 0.999 * depth
        assert separation(moved(a, shift * math.cos(angle), shift * math.sin(angle)), b) < 0


@given(shapes, st.floats(0.5, 0.99))
def test_a_shape_inside_another_overlaps_it(outer: Shape, share: float) -> None:
    inner = Shape(
        outer.x,
        outer.y,
        outer.radius * share,
        tuple((outer.x + share * (x - outer.x), outer.y + share * (y - outer.y)) for x, y in outer.vertices),
    )
    assert separation(inner, outer) < 0


@given(shapes, shapes)
def test_bounding_circles_reject_nothing_that_overlaps(a: Shape, b: Shape) -> None:
    assert conflict(a, b) == (separation(a, b) <= 1e-9)


def test_the_depth_of_two_boxes_is_the_least_shift() -> None:
    a, b = rectangle((0, 60), (0, 60)), rectangle((45, 105), (-10, 50))
    assert separation(a, b) == pytest.approx(-15)


def test_touching_is_a_conflict_and_a_margin_just_kept_is_none() -> None:
    a, b = rectangle((0, 60), (0, 60)), rectangle((60, 120), (0, 60))
    assert conflict(a, b)
    assert not conflict(a, moved(b, 2, 0), margin=2)
    assert conflict(a, moved(b, 1.99, 0), margin=2)


def test_what_is_not_a_number_is_a_conflict() -> None:
    assert conflict(disc(math.nan, 0, 10), disc(1000, 0, 10))
    assert conflict(rectangle((0, math.nan), (0, 60)), rectangle((500, 560), (0, 60)))


def test_half_a_turn_changes_nothing_about_boxes_and_discs_but_triangles() -> None:
    triangle = Footprint(polygon=((0, 0), (10, 0), (0, 10)))
    assert half_turn_symmetric(Footprint(box=(60, 30)))
    assert half_turn_symmetric(Footprint(disc=20))
    assert not half_turn_symmetric(triangle)
