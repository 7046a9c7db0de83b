"""Where light comes to follows how parts that were put down again are seen to stand, and what sight leaves open."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pico.geometry.seat import PlacementError, drawn, scatter_of
from pico.manifest.load import load_folder
from pico.model.observation import ObservedComponent, ObservedValue, Uncertainty
from pico.model.pose import Pose
from pico.optics.light import light_of
from pico.optics.nominal.bench import Nominal
from pico.optics.nominal.restood import Again, again, realigned
from pico.optics.nominal.spread import spread
from pico.optics.unseen import SEEN
from pico.resources import labs_dir

POSES = {"laser": Pose(120, 420), "p2": Pose(300, 420, 30), "lx_125": Pose(395, 420), "ly_150": Pose(670, 420),
         "cam": Pose(1060, 420)}  # fmt: skip
VALUES = {"laser": {"emission": True, "shutter": "open"}, "p2": {"angle": 90.0}}
SETUP = load_folder(labs_dir() / "shel").require()[0]
SPOT = ("cam.centroid.x", "cam.centroid.y")
SIGHT = Uncertainty(position=0.02, yaw=0.02)
SHORT = settings(max_examples=10, deadline=None)


def stood(pose: Pose, how: str = "stereo", sigma: Uncertainty = SIGHT, **more: object) -> ObservedComponent:
    return ObservedComponent(pose=pose, how=how, uncertainty=sigma, **more)  # type: ignore[arg-type]


def seen(part: str, now: Pose, then: ObservedComponent | None) -> Again:
    return again(SETUP, part, then, stood(now))


off = st.floats(-0.3, 0.3)


@given(one=st.tuples(off, off, off), other=st.tuples(off, off, off))
@SHORT
def test_the_spot_moves_by_the_jacobian_times_how_far_parts_stand_from_where_they_stood(
    one: tuple[float, float, float], other: tuple[float, float, float]
) -> None:
    moved = {"lx_125": one, "ly_150": other}
    were = {n: Pose(POSES[n].x - x, POSES[n].y - y, POSES[n].yaw - yaw) for n, (x, y, yaw) in moved.items()}
    placed = {n: seen(n, POSES[n], stood(pose)) for n, pose in were.items()}
    found = spread(SETUP, POSES, VALUES, placed, ["cam"])["cam"]
    nominal, by_part = Nominal(SETUP, POSES, VALUES), {}
    for n, by in moved.items():
        slopes = [nominal.by_placing(SPOT, n, way) for way in ("x", "y", "yaw")]
        by_part[n] = np.sum([slope * size for slope, size in zip(slopes, by, strict=True) if slope is not None], axis=0)
    assert 1e3 * np.array(found.moved[1:]) == pytest.approx(sum(by_part.values()), abs=5.0)  # um, to second order
    for part, alone in found.restood:
        assert 1e3 * np.array(alone[1:]) == pytest.approx(by_part[part.component], abs=5.0)


def test_how_far_a_part_stands_is_told_as_it_faces() -> None:
    found = seen("lx_125", POSES["lx_125"], stood(Pose(394.8, 419.9, -0.1))).seen
    assert found is not None
    assert (found.ahead, found.left, found.turned) == pytest.approx((0.2, 0.1, 0.1), abs=1e-3)
    assert (found.position, found.yaw) == pytest.approx((0.02 * math.sqrt(2), 0.02 * math.sqrt(2)))


def test_what_nobody_saw_both_times_is_as_the_catalog_says_of_two_placements() -> None:
    one, here = scatter_of(SETUP, "lx_125"), POSES["lx_125"]
    was = Pose(395.1, 420)
    twice = [math.sqrt(2) * getattr(one, way) for way in ("x", "y", "yaw", "pitch", "roll", "height")]
    unseen = (None, stood(was, "remembered"), stood(was, "placed"), ObservedComponent(presence="missing"),
              stood(was, presence="toppled"), stood(Pose(397, 420)), stood(Pose(395, 420, 10)))  # fmt: skip
    for then in unseen:
        found = seen("lx_125", here, then)
        assert (found.was, found.seen, found.sigma) == (here, None, PlacementError(*twice)), then
    assert again(SETUP, "lx_125", stood(was), stood(here, "placed")).seen is None


def test_sight_counts_where_it_is_surer_than_the_catalog_in_position_and_in_yaw() -> None:
    here, was, one = POSES["lx_125"], Pose(395.1, 420, 0.1), scatter_of(SETUP, "lx_125")
    found = seen("lx_125", here, stood(was, sigma=Uncertainty(position=0.02, yaw=1.0)))
    assert found.was == Pose(395.1, 420) and found.sigma.yaw == pytest.approx(math.sqrt(2) * one.yaw)
    found = seen("lx_125", here, stood(was, sigma=Uncertainty(position=1.0, yaw=0.02)))
    assert found.was == Pose(395, 420, 0.1) and found.sigma.x == pytest.approx(math.sqrt(2) * one.x)
    assert found.sigma.height == pytest.approx(math.sqrt(2) * one.height), "which nobody sees"


def test_light_that_another_part_was_aligned_for_is_no_longer_told_by_where_parts_stand() -> None:
    def at(value: float | None) -> dict[str, ObservedComponent]:
        return {
            "ly_150": stood(
                POSES["ly_150"], values={"stage_y": ObservedValue(value=value), "stage_z": ObservedValue(value=0.0)}
            )
        }

    assert not realigned(SETUP, {"ly_150", "cam"}, at(0.1), at(0.1))
    assert realigned(SETUP, {"ly_150"}, at(0.1), at(0.5)) and realigned(SETUP, {"ly_150"}, at(0.1), at(None))
    assert not realigned(SETUP, {"lx_125"}, at(0.1), at(0.5)), "it is not in this light"


def test_what_is_expected_is_off_by_its_standard_deviation() -> None:
    """Two placements of a lens as it scatters, each seen as surely as sight says, against the light of the truth."""
    lens, draw, each = POSES["lx_125"], random.Random(1), []
    about = SETUP.type_of("lx_125").frames.optical
    for n in range(80):
        one, other = (drawn(SETUP, "lx_125", n, count) for count in (1, 2))
        true = [error.of(lens) for error in (one, other)]
        looks = [stood(Pose(*(draw.gauss(v, s) for v, s in ((p.x, 0.02), (p.y, 0.02), (p.yaw, 0.02))))) for p in true]
        poses = {**POSES, "lx_125": looks[1].pose or lens}
        found = spread(SETUP, poses, VALUES, {"lx_125": again(SETUP, "lx_125", *looks)}, ["cam"])["cam"]
        spots = []
        for pose, error in zip(true, (one, other), strict=True):
            unseen = {"lx_125": SEEN.sitting(error.seat(1), about)}
            (arrival,) = light_of(SETUP, {**POSES, "lx_125": pose}, VALUES, unseen=unseen).at("cam")
            spots.append(arrival.center)
        moved = [b - a for a, b in zip(*spots, strict=True)]
        each.append([(moved[k] - found.moved[1 + k]) / s for k, s in enumerate((found.left, found.up))])
    rms = np.sqrt(np.mean(np.square(each), axis=0))
    assert (rms > 0.75).all() and (rms < 1.2).all(), rms


def test_sight_makes_surer_where_the_spot_is_to_be_to_the_side_but_not_up() -> None:
    here = POSES["lx_125"]
    blind, sure = (
        spread(SETUP, POSES, VALUES, {"lx_125": seen("lx_125", here, then)}, ["cam"])["cam"]
        for then in (None, stood(replace(here, y=here.y + 0.05)))
    )
    assert sure.left < blind.left / 2 and sure.up == pytest.approx(blind.up, rel=0.02)
