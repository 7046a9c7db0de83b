"""Light finds components as they sit: a mirror that leans steers out of the plane, a lens that is raised decentres."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from light_benches import kind, light, setup_of

from pico.geometry.seat import Seat
from pico.model.pose import Pose
from pico.optics.light import light_of
from pico.optics.unseen import SEEN

KINDS = {"laser": kind("hene_laser"), "part": kind("mirror_tip_tilt"), "cam": kind("beam_camera")}
FOLDED = {"laser": Pose(100, 600), "part": Pose(500, 600, 45), "cam": Pose(500, 300, -90)}
ALONG = {"laser": Pose(100, 420), "part": Pose(400, 420), "cam": Pose(480, 420)}


def seen(kinds: object, poses: object, seat: Seat) -> tuple[float, float]:
    setup = setup_of(kinds)  # type: ignore[arg-type]
    unseen = {"part": SEEN.sitting(seat, setup.type_of("part").frames.optical)}
    found = light_of(setup, poses, lit=lambda _: True, unseen=unseen)  # type: ignore[arg-type]
    (arrival,) = found.at("cam")
    return arrival.center


def test_a_seat_that_is_level_is_no_seat() -> None:
    (upright,) = light(KINDS, FOLDED).at("cam")
    assert seen(KINDS, FOLDED, Seat(count=3)) == upright.center


def test_a_mirror_that_leans_back_sends_the_beam_up_by_twice_the_pitch_across_it() -> None:
    """At 45 deg a pitch p tips the normal by p: out of the plane the beam turns by 2 p cos 45 deg."""
    across, up = seen(KINDS, FOLDED, Seat(pitch=0.05))
    turned = 2 * math.radians(0.05) * math.cos(math.radians(45))
    assert up == pytest.approx(300 * turned, rel=2e-3)
    assert across == pytest.approx(70 * math.radians(0.05) * math.sqrt(2), abs=2e-3)  # its face has moved back


def test_a_mirror_that_leans_about_its_own_normal_only_steps_aside() -> None:
    assert seen(KINDS, FOLDED, Seat(roll=0.05)) == pytest.approx((0.0, 0.0), abs=1e-6)


def test_the_pitch_of_a_mirror_is_its_tilt_about_its_foot() -> None:
    (tilted,) = light(KINDS, FOLDED, {"part": {"tilt": math.radians(0.1) * 1e3}}).at("cam")
    assert seen(KINDS, FOLDED, Seat(pitch=0.1))[1] == pytest.approx(tilted.center[1], rel=1e-3)


@given(height=st.floats(-0.3, 0.3), roll=st.floats(-0.2, 0.2))
@settings(max_examples=20, deadline=None)
def test_a_lens_is_decentred_by_its_height_and_to_the_side_by_its_roll(height: float, roll: float) -> None:
    """A thin lens that is off by d turns the ray by d / f: on a screen at distance s it lands at d s / f."""
    kinds = {**KINDS, "part": kind("plano_convex_100")}
    down = 70 * (1 - math.cos(math.radians(roll)))
    aside = -70 * math.sin(math.radians(roll))
    expected = (aside * 0.8, (height - down) * 0.8)
    assert seen(kinds, ALONG, Seat(height=height, roll=roll)) == pytest.approx(expected, abs=1e-6)


def test_an_iris_that_stands_low_stops_more() -> None:
    kinds = {**KINDS, "part": kind("iris")}
    found = []
    for height in (0.0, -0.3):
        values = {"part": {"opening": 1.0}}
        unseen = {"part": SEEN.sitting(Seat(height=height), (0.0, 0.0, 70.0))}
        (arrival,) = light_of(setup_of(kinds), ALONG, values, lit=lambda _: True, unseen=unseen).at("cam")
        found.append(arrival.power)
    assert found[1] < 0.9 * found[0]
