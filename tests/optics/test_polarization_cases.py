"""Golden polarization cases, each worked out by hand: what stands here is not the code's own figure."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from light_benches import kind, light
from numpy.typing import NDArray

from pico.model.pose import Pose
from pico.optics.beam import Amplitudes, Beam, Wave, beyond
from pico.optics.gaussian import from_waist
from pico.optics.light import Light
from pico.optics.polarization import fresnel
from pico.optics.rays import Surface

LASER = Pose(100, 400)  # its exit at x = 160
SILVER = {"refractive_index": 0.056, "extinction_coefficient": 4.28}
parts = st.floats(-1, 1)


def seen(found: Light, name: str = "cam") -> tuple[float, float, float, float]:
    """S0 to S3 of the one beam on a camera."""
    (arrival,) = found.at(name)
    return arrival.beam.stokes


def stokes_of(across: complex, up: complex) -> tuple[float, float, float, float]:
    both = across.conjugate() * up
    return abs(across) ** 2 + abs(up) ** 2, abs(across) ** 2 - abs(up) ** 2, 2 * both.real, 2 * both.imag


def beam_of(across: complex, up: complex, index: float = 1.0) -> Beam:
    """Return a beam along x, `across` along y and `up` along z."""
    along, left, top = np.eye(3)
    wave = Wave((across * left + up * top).astype(complex), np.zeros(2, dtype=complex))
    return Beam("laser", 632.8e-6, np.zeros(3), along, left, from_waist(0.5, 632.8e-6), (wave,), index=index)


def folded(beam: Beam, *ways: tuple[float, float, float], amplitudes: Amplitudes | None = None) -> Beam:
    """Return a beam sent into each direction in turn by a mirror 100 mm on."""
    for way in ways:
        normal = np.array(way) - beam.along
        vertex = beam.at + 100 * beam.along
        plane = Surface(vertex, normal / np.linalg.norm(normal), before=beam.index, after=beam.index)
        sent = beyond(beam, plane, reflect=True, amplitudes=amplitudes)
        assert sent is not None
        beam = sent
    return beam


def field_of(beam: Beam) -> NDArray[np.complex128]:
    """Return the field of its one wave without Gouy's phase, atan (z / z_R), z_R = pi w^2 / wavelength."""
    (wave,) = beam.waves
    field: NDArray[np.complex128] = wave.field * cmath.exp(1j * math.atan(beam.length / (math.pi * 0.25 / 632.8e-6)))
    return field


@given(parts, parts, parts, parts)
def test_periscope_with_any_polarization(a: float, b: float, c: float, d: float) -> None:
    """A conductor sends E back as -E + 2 n (n E). Along x, up, then to the left: with n = (-1, 0, 1)/sqrt 2 then
    (0, 1, -1)/sqrt 2 the field (0, a, b) becomes (-b, -a, 0), then (b, 0, a); left of a beam along y is -x."""
    across, up = complex(a, b), complex(c, d)
    out = folded(beam_of(across, up), (0, 0, 1), (0, 1, 0))
    assert field_of(out) == pytest.approx(np.array([up, 0, across]), abs=1e-12)
    assert out.across == pytest.approx([-1, 0, 0]) and out.up == pytest.approx([0, 0, 1])
    s0, s1, s2, s3 = stokes_of(across, up)
    assert out.stokes == pytest.approx((s0, -s1, -s2, s3), abs=1e-12)


@given(parts, parts, parts, parts)
def test_three_mirrors_around_the_corner_of_a_cube(a: float, b: float, c: float, d: float) -> None:
    """x to y to z to x: (0, a, b), (-a, 0, -b), (a, b, 0), (0, -b, -a). An odd number of mirrors turns S3 over."""
    across, up = complex(a, b), complex(c, d)
    out = folded(beam_of(across, up), (0, 1, 0), (0, 0, 1), (1, 0, 0))
    assert field_of(out) == pytest.approx(np.array([0, -up, -across]), abs=1e-12)
    s0, s1, s2, s3 = stokes_of(across, up)
    assert out.stokes == pytest.approx((s0, -s1, s2, -s3), abs=1e-12)


@pytest.mark.parametrize(
    ("yaw", "wanted"), [(0.0, (1, -0.5, math.sqrt(0.75), 0)), (180.0, (1, -0.5, -math.sqrt(0.75), 0))]
)
def test_half_wave_plate_turned_round(yaw: float, wanted: tuple[float, ...]) -> None:
    """At 30 deg it turns level light to 60 deg; seen from its other side it stands at -30 deg."""
    kinds = {"laser": kind("hene_laser"), "h": kind("half_wave_plate"), "cam": kind("beam_camera")}
    poses = {"laser": LASER, "h": Pose(250, 400, yaw), "cam": Pose(400, 400)}
    assert seen(light(kinds, poses, {"h": {"angle": 30.0}})) == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize(("yaw", "wanted"), [(0.0, -1.0), (180.0, 1.0)])
def test_quarter_wave_plate_turned_round(yaw: float, wanted: float) -> None:
    """Level light, fast axis at +45 deg: along fast f and slow s (s at 135 deg) it is (1, -1)/sqrt 2, and s comes a
    quarter later, exp(i pi/2): (1, -i)/sqrt 2, clockwise."""
    kinds = {"laser": kind("hene_laser"), "q": kind("quarter_wave_plate"), "cam": kind("beam_camera")}
    poses = {"laser": LASER, "q": Pose(250, 400, yaw), "cam": Pose(400, 400)}
    assert seen(light(kinds, poses, {"q": {"angle": 45.0}})) == pytest.approx((1, 0, 0, wanted), abs=1e-12)


def test_a_silver_mirror_at_45_deg_makes_linear_light_elliptical() -> None:
    """At 45 deg r_p = r_s^2 of any isotropic material (Abelès). With N = 0.056 + 4.28 i: q = sqrt(2 N^2 - 1) =
    0.0781 + 6.1349 i, r_s = (1 - q)/(1 + q). The light is level (p) and upright (s) in equal parts."""
    q = cmath.sqrt(2 * (0.056 + 4.28j) ** 2 - 1)
    r = (1 - q) / (1 + q)
    size = abs(r) ** 2
    assert size == pytest.approx(0.9919437, abs=2e-5)
    wanted = ((size**2 + size) / 2, (size**2 - size) / 2, size * r.real, -size * r.imag)
    kinds = {"laser": kind("hene_laser", polarization=45.0), "m": kind("mirror_tip_tilt", **SILVER),
             "cam": kind("beam_camera")}  # fmt: skip
    found = seen(light(kinds, {"laser": LASER, "m": Pose(300, 400, -45), "cam": Pose(300, 600, 90)}))
    assert found == pytest.approx(wanted, abs=1e-12)
    assert abs(found[3]) > 0.25, "elliptical: the metal holds p and s back by other phases"
    perfect = folded(beam_of(1, 1), (0, 1, 0))
    assert found[2] * perfect.stokes[2] > 0, "a good metal is nearly a perfect one"


def test_brewster_angle() -> None:
    """tan = 1.5: level light (p) passes a bare plate whole; of upright light each face sends back
    ((n^2 - 1)/(n^2 + 1))^2 = (5/13)^2, which is all upright."""
    for angle, back in ((0.0, 0.0), (90.0, (5 / 13) ** 2)):
        kinds = {
            "laser": kind("hene_laser", polarization=angle), "cam": kind("beam_camera"),
            "f": kind("neutral_density_filter", optical_density=0.0, thickness=1.0, refractive_index=1.5,
                      coating="none"),
        }  # fmt: skip
        poses = {"laser": LASER, "f": Pose(300, 400, math.degrees(math.atan(1.5))), "cam": Pose(500, 400)}
        found = light(kinds, poses)
        main = max(a.power for a in found.at("cam"))
        assert main == pytest.approx((1 - back) ** 2, abs=1e-9)
        others = [c for c in found.crossings if c.before == 0 and c.component != "cam"]
        assert bool(others) == (angle == 90.0)
        for crossing in others:
            s0, s1, _, _ = crossing.beam.stokes
            assert s1 == pytest.approx(-s0)


def test_a_bare_plate_turns_polarization_towards_its_plane_of_incidence() -> None:
    """Each face passes s less than p by cos(i - i'): light at 45 deg leaves at atan cos^2 (i - i')."""
    tilt, n = math.radians(50.0), 1.6
    apart = tilt - math.asin(math.sin(tilt) / n)
    kinds = {
        "laser": kind("hene_laser", polarization=45.0), "cam": kind("beam_camera"),
        "f": kind("neutral_density_filter", optical_density=0.0, thickness=1.0, refractive_index=n, coating="none"),
    }  # fmt: skip
    found = light(kinds, {"laser": LASER, "f": Pose(300, 400, 50.0), "cam": Pose(500, 400)})
    _, s1, s2, s3 = max((a.beam for a in found.at("cam")), key=lambda b: b.power).stokes
    assert math.atan2(s2, s1) / 2 == pytest.approx(math.atan(math.cos(apart) ** 2), abs=1e-12)
    assert s3 == pytest.approx(0.0, abs=1e-12)


@given(st.floats(-90, 90))
def test_quarter_wave_plate_in_double_pass(angle: float) -> None:
    """With a mirror behind it, it mirrors the field at its fast axis: level light lies at twice its angle in space,
    and so at minus that for who looks from the other side."""
    kinds = {"laser": kind("hene_laser"), "q": kind("quarter_wave_plate"), "m": kind("mirror_tip_tilt")}
    found = light(kinds, {"laser": LASER, "q": Pose(250, 400), "m": Pose(400, 400)}, {"q": {"angle": angle}})
    assert [c.component for c in found.crossings] == ["q", "m", "q", "laser"]
    twice = math.radians(4 * angle)
    assert found.crossings[-1].beam.stokes == pytest.approx((1, math.cos(twice), -math.sin(twice), 0), abs=1e-9)


@given(st.floats(-90, 90))
def test_what_comes_straight_back_shows_minus_its_angle_and_turns_the_other_way(angle: float) -> None:
    turned = math.radians(2 * angle)
    kinds = {"laser": kind("hene_laser", polarization=angle), "m": kind("mirror_tip_tilt")}
    back = light(kinds, {"laser": LASER, "m": Pose(400, 400)}).crossings[-1]
    assert back.component == "laser"
    assert back.beam.stokes == pytest.approx((1, math.cos(turned), -math.sin(turned), 0), abs=1e-9)
    left, right = (folded(beam_of(1, turn), (-1, 0, 0)).stokes[3] for turn in (1j, -1j))
    assert (left, right) == pytest.approx((-2, 2))


def test_s3_says_which_way_the_field_turns_in_time() -> None:
    """Re E exp(-iwt) turns counter-clockwise about the beam's own direction where S3 > 0, on any path."""
    for across, up in ((1, 0.3j), (0.2, -1j), (1 + 0.5j, 0.7j)):
        for ways in ((), ((0, 1, 0),), ((0, 0, 1), (0, 1, 0)), ((0.6, 0, 0.8), (0, -1, 0), (-1, 0, 0))):
            beam = folded(beam_of(across, up), *ways)
            now, later = field_of(beam).real, (field_of(beam) * np.exp(-0.3j)).real
            assert math.copysign(1, np.cross(now, later) @ beam.along) == math.copysign(1, beam.stokes[3])


def test_polarizing_cube() -> None:
    """Level light (p) passes. With T_p = 0.96, extinction 400 and R_s = 0.99, light at 60 deg of 1 mW: p is 0.25 mW,
    s 0.75 mW. On: 0.24 + 0.0018; to the side: what of p is left, 0.01, and 0.7425."""
    kinds = {
        "laser": kind("hene_laser", polarization=60.0), "on": kind("beam_camera"), "side": kind("beam_camera"),
        "cube": kind("polarizing_beam_splitter", transmittance=0.96, reflectance=0.99, extinction=400.0),
    }  # fmt: skip
    found = light(kinds, {"laser": LASER, "cube": Pose(300, 400), "on": Pose(500, 400), "side": Pose(300, 600, 90)})
    on, side = seen(found, "on"), seen(found, "side")
    assert on[:2] == pytest.approx((0.2418, 0.24 - 0.0018), abs=1e-12)
    assert side[:2] == pytest.approx((0.7525, 0.01 - 0.7425), abs=1e-12)
    assert on[2] == pytest.approx(2 * math.sqrt(0.24 * 0.0018)) and on[3] == pytest.approx(0, abs=1e-12)


def test_near_its_normal_a_plain_splitter_sends_light_back_as_a_mirror_does() -> None:
    """Along the normal no direction is marked, so a plain coating sends E back as r E whatever its direction: what
    stood at 30 deg stands at -30 deg for who looks from the other side, and circular light turns the other way."""
    for half, quarter, wanted in ((15.0, 30.0, (1, 0.5, -math.sqrt(0.75), 0)), (0.0, 45.0, (1, 0, 0, 1))):
        kinds = {
            "laser": kind("hene_laser"), "h": kind("half_wave_plate"), "q": kind("quarter_wave_plate"),
            "b": kind("beam_splitter_50_50", transmittance=0.0, reflectance=1.0, fold=178.0),
        }  # fmt: skip
        poses = {"laser": LASER, "h": Pose(230, 400), "q": Pose(300, 400), "b": Pose(900, 400)}
        found = light(kinds, poses, {"h": {"angle": half}, "q": {"angle": quarter}})
        (back,) = (c for c in found.crossings if c.before is not None and found.crossings[c.before].component == "b")
        assert back.beam.along[0] < -0.99
        assert back.beam.stokes == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("degrees", [48 + 37 / 60, 54 + 37 / 60])
def test_fresnel_rhomb(degrees: float) -> None:
    """Two total reflections in glass of 1.51 at 48 deg 37' or 54 deg 37' each put s 45 deg after p in phase, so light
    at 45 deg becomes circular (Born and Wolf, 1.5.4); tan(d/2) = cos i sqrt(sin^2 i - 1/n^2) / sin^2 i."""
    n, i = 1.51, math.radians(degrees)
    turn = math.pi - 2 * i
    ways = (math.cos(turn), math.sin(turn), 0.0), (1.0, 0.0, 0.0)

    def total(cosine: float) -> tuple[complex, complex]:
        return fresnel(n, 1.0, cosine)[:2]

    once, rhomb = (folded(beam_of(1, 1, n), *ways[:count], amplitudes=total) for count in (1, 2))
    late = 2 * math.atan(math.cos(i) * math.sqrt(math.sin(i) ** 2 - 1 / n**2) / math.sin(i) ** 2)
    assert late == pytest.approx(math.pi / 4, abs=1e-3)
    p, s = (field_of(once) @ axis for axis in (once.across, once.up))
    assert abs(p) == pytest.approx(1, abs=1e-12) and abs(s) == pytest.approx(1, abs=1e-12)
    assert cmath.phase(s / p) == pytest.approx(late, abs=1e-12)
    s0, s1, s2, s3 = rhomb.stokes
    assert (s1 / s0, s2 / s0, s3 / s0) == pytest.approx((0, math.cos(2 * late), math.sin(2 * late)), abs=1e-12)
    assert s3 / s0 == pytest.approx(1, abs=2e-6)


def test_a_polarizer_turned_round_passes_what_stands_at_minus_its_angle() -> None:
    for light_at, wanted in ((-20.0, 1.0), (70.0, 0.0), (20.0, math.cos(math.radians(40)) ** 2)):
        kinds = {"laser": kind("hene_laser", polarization=light_at), "p": kind("linear_polarizer"),
                 "cam": kind("beam_camera")}  # fmt: skip
        found = light(kinds, {"laser": LASER, "p": Pose(260, 400, 180), "cam": Pose(400, 400)}, {"p": {"angle": 20.0}})
        assert sum(a.power for a in found.at("cam")) == pytest.approx(wanted, abs=1e-12)
