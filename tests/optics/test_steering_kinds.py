"""Flip mirrors, prisms, Wollaston prisms, gratings and expanders against closed forms; geometry agrees with light."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from light_benches import kind, light, setup_of

from pico.model.pose import Pose
from pico.optics.axis import axis_of
from pico.optics.gaussian import from_waist
from pico.optics.light import Light

LASER = Pose(100, 400)  # its exit at x = 160
WAVELENGTH = 632.8e-6  # mm


def bench(name: str, at: Pose, values: dict[str, object] | None = None, *, polarization: float = 0.0,
          **parameters: object) -> Light:  # fmt: skip
    laser = kind("hene_laser", waist_radius=0.5, polarization=polarization)
    return light({"laser": laser, "x": kind(name, **parameters)}, {"laser": LASER, "x": at}, {"x": values or {}})


@pytest.mark.parametrize(
    ("name", "pose", "flipped"),
    [
        ("mirror_flip", Pose(400, 400, 40), "up"),
        ("mirror_flip", Pose(400, 400, 40), "down"),
        ("right_angle_prism", Pose(400, 400), ""),
        ("right_angle_prism", Pose(400, 400, 90), ""),
        ("right_angle_prism", Pose(400, 400, 180), ""),
        ("wollaston_prism", Pose(400, 400), ""),
        ("wollaston_prism", Pose(400, 400, 175), ""),
        ("reflection_grating", Pose(400, 400, 20), ""),
        ("reflection_grating", Pose(400, 400, -50), ""),
    ],
)
def test_geometry_alone_sends_beams_where_light_does(name: str, pose: Pose, flipped: str) -> None:
    kinds = {"laser": kind("hene_laser", polarization=30.0), "x": kind(name)}
    poses, values = {"laser": LASER, "x": pose}, {"x": {"flipped": flipped}}
    axis, found = axis_of(setup_of(kinds), poses, "laser", values), light(kinds, poses, values)
    met = {(m.component, m.event, *np.round(m.at, 3) + 0.0) for leg in axis.legs for m in leg.met}
    assert met == {(c.component, c.event, *np.round(c.beam.at, 3) + 0.0) for c in found.crossings}


def test_a_flip_mirror_lets_light_pass_while_it_is_down() -> None:
    up, down = (bench("mirror_flip", Pose(400, 400, 45), {"flipped": way}) for way in ("up", "down"))
    assert up.crossings[0].event == "reflected" and up.crossings[0].onward == pytest.approx(0.975, rel=1e-6)
    assert down.crossings[0].event == "passed" and down.crossings[1].beam.along == pytest.approx([1, 0, 0])
    assert down.crossings[0].onward == pytest.approx(1.0, rel=1e-9)


def test_total_reflection_turns_p_against_s() -> None:
    found = bench("right_angle_prism", Pose(400, 400), polarization=45.0, transmission=1.0)
    beam, n = found.crossings[1].beam, 1.5151
    assert beam.along == pytest.approx([0, 1, 0], abs=1e-12) and beam.power == pytest.approx(1.0, rel=1e-9)
    assert beam.index == 1.0
    assert beam.path - beam.length == pytest.approx((n - 1) * 25.4, rel=1e-9)
    # Born and Wolf 1.5.4, eq. (61): tan(delta / 2) = cos t (sin^2 t - 1 / n^2)^1/2 / sin^2 t, from a mirror's pi
    delta = 2 * math.atan(math.sqrt(0.5) * math.sqrt(0.5 - n**-2) / 0.5)
    _, s1, s2, s3 = beam.stokes
    assert math.hypot(s2, s3) == pytest.approx(1.0, rel=1e-9) and s1 == pytest.approx(0.0, abs=1e-9)
    assert abs(math.sin(cmath.phase(complex(s2, s3)))) == pytest.approx(abs(math.sin(delta)), rel=1e-9)


def test_a_prism_that_is_turned_too_far_loses_light_and_no_power_is_lost() -> None:
    found = bench("right_angle_prism", Pose(400, 400, 12), transmission=1.0, clear_diameter=25.0)
    other = bench("right_angle_prism", Pose(400, 400, -12), transmission=1.0, clear_diameter=25.0)
    counts = sorted(sum(c.before == 0 for c in one.crossings) for one in (found, other))
    assert counts == [1, 2]
    for one in (found, other):
        assert one.crossings[0].onward == pytest.approx(1 - one.crossings[0].clipped, rel=1e-9)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
def test_a_wollaston_divides_by_the_law_of_malus(angle: float) -> None:
    found = bench("wollaston_prism", Pose(400, 400), polarization=angle, transmission=1.0, extinction=None)
    sent = {float(np.sign(c.beam.along[1])): c for c in found.crossings if c.before == 0}
    powers = [sent[side].power if side in sent else 0.0 for side in (1.0, -1.0)]
    malus = math.cos(math.radians(angle)) ** 2
    assert powers == pytest.approx([malus, 1 - malus], abs=1e-9)
    for side, crossing in sent.items():
        way = math.degrees(math.atan2(crossing.beam.along[1], crossing.beam.along[0]))
        assert way == pytest.approx(side * 0.5, abs=1e-9)
        s0, s1, *_ = crossing.beam.stokes
        assert s1 == pytest.approx(side * s0, rel=1e-9)


def test_a_wollaston_with_leaks_makes_no_light() -> None:
    found = bench("wollaston_prism", Pose(400, 400), polarization=20.0, transmission=1.0, extinction=50.0)
    assert found.crossings[0].onward == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("yaw", [0.5, 20.0, -35.0])
def test_a_grating_sends_orders_by_its_equation_and_widens_them(yaw: float) -> None:
    found = bench("reflection_grating", Pose(400, 400, yaw))
    came = found.crossings[0].beam
    turned = math.radians(yaw)
    left, out = np.array([-math.sin(turned), math.cos(turned), 0]), -np.array([math.cos(turned), math.sin(turned), 0])
    sent = {round(float((c.beam.along - came.along) @ left) / (600 * WAVELENGTH)): c for c in found.crossings[1:]}
    shares = {0: 0.12, 1: 0.68, -1: 0.06}
    leaving = {m for m in shares if abs(float(came.along @ left) + m * 600 * WAVELENGTH) < 1}
    assert set(sent) == leaving
    for order, crossing in sent.items():
        sine = float(came.along @ left) + order * 600 * WAVELENGTH
        assert float(crossing.beam.along @ left) == pytest.approx(sine, abs=1e-12)
        assert crossing.power == pytest.approx(shares[order], rel=1e-6) and crossing.beam.along @ out > 0
        # at the grating it is wider by cos(out) / cos(in) in its plane, and as high as it was
        from pico.optics.beam import forward

        there = forward(crossing.beam, came.length - crossing.beam.length)
        wide = math.sqrt(1 - sine**2) / abs(float(came.along @ out))
        k = came.wave_number
        spot = [math.sqrt(2 / (k * there.curvature.imag[n, n])) for n in (0, 1)]
        assert spot == pytest.approx([wide * came.widths[0], came.widths[0]], rel=1e-9)


@pytest.mark.parametrize(("yaw", "by"), [(0.0, 3.0), (180.0, 1 / 3)])
def test_an_expander_is_the_matrix_of_a_telescope(yaw: float, by: float) -> None:
    found = bench("beam_expander", Pose(400, 400, yaw), transmission=1.0, length=40.0)
    before, behind = found.crossings[0].beam, found.crossings[1].beam
    assert before.at[0] == pytest.approx(380) and behind.length == pytest.approx(behind.at[0] - 160)
    q = 1 / from_waist(0.5, WAVELENGTH, 220.0)[0, 0]
    q = (by * q + 40.0) / (1 / by) + (behind.at[0] - 420)
    assert behind.curvature == pytest.approx(np.eye(2) / q, rel=1e-9, abs=1e-15)
    assert found.crossings[0].onward == pytest.approx(1.0, rel=1e-6)


def test_an_expander_magnifies_an_offset_and_divides_an_angle() -> None:
    found = bench("beam_expander", Pose(400, 400.5, 0.2), transmission=1.0, length=40.0)
    before, behind = found.crossings[0].beam, found.crossings[1].beam
    turned = math.radians(0.2)
    axis, left = np.array([math.cos(turned), math.sin(turned)]), np.array([-math.sin(turned), math.cos(turned)])
    center = np.array([400, 400.5])
    start = behind.at - (behind.length - before.length - 40.0) * behind.along
    slope = float(before.along[:2] @ left / (before.along[:2] @ axis))
    offset = float((before.at[:2] - center + 20 * axis) @ left)
    assert float((start[:2] - center - 20 * axis) @ left) == pytest.approx(3 * offset + 40 * slope, abs=1e-9)
    assert float(behind.along[:2] @ left / (behind.along[:2] @ axis)) == pytest.approx(slope / 3, abs=1e-12)


@pytest.mark.parametrize("position", range(1, 7))
def test_a_filter_wheel_weakens_by_the_filter_in_the_beam(position: int) -> None:
    found = bench("filter_wheel", Pose(400, 400), {"position": f"at_{position}"})
    density = [0, 0.5, 1, 2, 3, 4][position - 1]
    assert found.crossings[0].onward == pytest.approx(10**-density, rel=1e-9)


def test_a_filter_wheel_at_no_known_position_is_taken_for_clear() -> None:
    found = bench("filter_wheel", Pose(400, 400))
    assert found.crossings[0].onward == pytest.approx(1.0, rel=1e-9)
    assert "nobody knows which filter" in found.crossings[1].beam.unknown


def test_an_avalanche_photodiode_reads_a_microwatt() -> None:
    from pico.optics.instruments import power_reading

    kinds = {"laser": kind("hene_laser", power=1e-3, waist_radius=0.1, waist_position=240.0),
             "x": kind("avalanche_photodiode")}  # fmt: skip
    found = light(kinds, {"laser": LASER, "x": Pose(412, 400)})
    read = power_reading(found.at("x"), found.parts["x"])
    # 1 uW at 20 A/W into 50 kV/A are 1 V
    assert read.value == pytest.approx(1.0, abs=6 * 0.0012) and not read.saturated


def test_the_table_of_elements_names_all_that_light_reads() -> None:
    from pathlib import Path

    from pico.manifest.checks.elements import own
    from pico.manifest.checks.parameters import NUMBERS

    page = (Path(__file__).parents[2] / "docs/how-to/light.md").read_text()
    rows = {line.split("`")[1]: line for line in page.splitlines() if line.startswith("| `")}
    assert set(own()) <= set(rows)
    for name, numbers in NUMBERS.items():
        own = [number for number in numbers if not number.startswith("density_")]
        assert all(f"`{number}`" in rows[name] for number in own), name


@pytest.mark.parametrize(("name", "yaw"), [("right_angle_prism", 2.0), ("wollaston_prism", 3.0)])
def test_light_that_is_sent_back_finds_its_way(name: str, yaw: float) -> None:
    from dataclasses import replace

    from pico.optics.following import element

    found = bench(name, Pose(400, 400, yaw), polarization=0.0, extinction=None, transmission=1.0)
    first, behind, part = found.crossings[0].beam, found.crossings[1].beam, found.parts["x"]
    back = replace(behind, along=-behind.along, across=-behind.across, path=0.0, length=0.0)
    (again,) = (b for b in element(part.optic.element).meet(part, back).onward)
    assert again.along == pytest.approx(-first.along, abs=1e-12)
    aside = again.at - first.at
    assert aside - (aside @ first.along) * first.along == pytest.approx([0, 0, 0], abs=1e-9)
    assert again.power == pytest.approx(first.power, rel=1e-6)
