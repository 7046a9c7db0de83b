"""How components come to sit: as their types scatter, the same for the same seed, and by seating where no type says."""

from __future__ import annotations

import statistics
from dataclasses import fields, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.geometry.seat import PlacementError, drawn, scatter, scatter_of
from pico.manifest.catalog import load_catalog
from pico.model.catalog import SEATINGS, Repeatability, as_first_written
from pico.model.lab import Lab, Part, Table
from pico.model.pose import Pose
from pico.model.setup import Setup

CATALOG = load_catalog()
AXES = tuple(f.name for f in fields(PlacementError))


def bench(kind: str = "mirror_tip_tilt", **more: object) -> Setup:
    part = Part(type=kind, home="a", **more)  # type: ignore[arg-type]
    return Setup(lab=Lab(name="x", table=Table(size=(500, 500)), robots={}, inventory={"m": part}), catalog=CATALOG)


@given(seed=st.integers(0, 10**6), count=st.integers(0, 1000))
def test_the_same_placement_errs_the_same_and_another_one_otherwise(seed: int, count: int) -> None:
    first = drawn(bench(), "m", seed, count)
    assert first == drawn(bench(), "m", seed, count)
    assert first != drawn(bench(), "m", seed, count + 1) and first != drawn(bench(), "m", seed + 1, count)


@pytest.mark.parametrize("kind", ["mirror_tip_tilt", "piezo_mirror", "room_lamp"])
def test_placements_scatter_as_the_catalog_says(kind: str) -> None:
    setup = bench(kind)
    many = [drawn(setup, "m", 1, count) for count in range(2000)]
    for axis in AXES:
        values = [getattr(one, axis) for one in many]
        assert statistics.stdev(values) == pytest.approx(getattr(scatter_of(setup, "m"), axis), rel=0.08), axis
        assert abs(statistics.fmean(values)) < 0.1 * statistics.stdev(values), axis


def test_a_multiple_errs_as_many_times_as_much() -> None:
    once, thrice = drawn(bench(), "m", 3, 1), drawn(bench(), "m", 3, 1, 3.0)
    assert all(getattr(thrice, axis) == pytest.approx(3 * getattr(once, axis)) for axis in AXES)
    assert drawn(bench(), "m", 3, 1, 0.0).of(Pose(5, 6, 7)) == Pose(5, 6, 7)


@pytest.mark.parametrize("seating", SEATINGS)
def test_what_a_type_does_not_say_follows_from_the_seating(seating: str) -> None:
    found = scatter(Repeatability(position=0.3, yaw=0.1, roll=0.5), seating)  # type: ignore[arg-type]
    pitch, _, height = SEATINGS[seating]  # type: ignore[index]
    assert found == PlacementError(0.3, 0.3, 0.1, pitch, 0.5, height)


def test_the_types_of_the_catalog_say_it_themselves_and_are_still_written_as_at_first() -> None:
    for kind in CATALOG.values():
        said = (kind.repeatability.pitch, kind.repeatability.roll, kind.repeatability.height)
        assert said == SEATINGS[kind.seating], kind.name
        assert as_first_written(kind).repeatability.pitch is None
    own = replace(CATALOG["iris"], repeatability=Repeatability(pitch=0.5))
    assert as_first_written(own).repeatability.pitch == 0.5  # a lab's own figure counts for its digest
