"""A Mach-Zehnder interferometer against scalar fields written apart (`oracles.two_beams`): fringes, visibility by the
spectrum of the source, both ports, overlap and polarization of the arms, and what a camera's frames show of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from interferometer_benches import (
    EQUAL,
    MODE,
    POSES,
    WAIST,
    WAVELENGTH,
    arms,
    bench,
    expected,
    read,
    seen,
    source,
    wanted,
)
from light_benches import kind, light, setup_of
from oracles import two_beams

from pico.kernels.frame import Frame
from pico.kernels.standard import visibility as fringes
from pico.model.catalog import ComponentType, SpectralLine
from pico.model.pose import Pose
from pico.optics.beam_table import troubles
from pico.optics.coherence import Line, coherence_length, degree, spectra_of
from pico.optics.instruments import camera_frame, power_on, sensor_of
from pico.optics.light import irradiance, out_of_step


def visibility_of(laser: ComponentType, delta: float, **more: Any) -> float:
    """Return the visibility on the meter while the stage scans a wave around a difference of the arms' paths."""
    steps = [delta / 2 + n * WAVELENGTH / 8 for n in range(4)]
    p = [read(bench(laser, {"delay_stage_x": EQUAL + step}, **more)) for step in steps]
    return math.hypot(p[0] - p[2], p[1] - p[3]) / (sum(p) / 2)


def agree(laser: ComponentType, delta: float, degree: Callable[[float], float]) -> None:
    """The meter reads what scalar fields say, at three phases around a difference of the arms' paths."""
    for apart in (delta + n * WAVELENGTH / 8 for n in (0, 1, 2)):
        found = bench(laser, {"delay_stage_x": EQUAL + apart / 2})
        assert read(found) == pytest.approx(expected(apart, degree), abs=1e-6), apart


@pytest.mark.parametrize("tip", [0.0, 0.3, -1.0, 2.0])
@pytest.mark.parametrize("stage", [EQUAL, EQUAL + WAVELENGTH / 8, 120.0])
def test_fringes_are_those_of_scalar_fields(tip: float, stage: float) -> None:
    picture, y, z = seen(bench(source(), {"m3_tip": tip, "delay_stage_x": stage}).at("cam"))
    fields = wanted(y, z, arms(stage, tip * 1e-3))
    assert np.abs(picture - fields).max() < 1e-6 * fields.max()


def test_the_period_of_fringes_is_the_wavelength_over_the_angle() -> None:
    wide = source(waist_radius=6.0)  # flat over all the way, to 1e-9 of the fringes' direction
    y = np.linspace(-1.5, 1.5, 4001)
    for tip in (0.5, 1.0, 2.0):
        found = bench(wide, {"m3_tip": tip})
        both, alone = found.at("cam"), [one.irradiance(y, np.zeros(1))[0] for one in found.at("cam")]
        cosine = (irradiance(both, y, np.zeros(1))[0] - sum(alone)) / (2 * np.sqrt(alone[0] * alone[1]))
        crossing = np.nonzero(np.diff(np.signbit(cosine)))[0]
        place = y[crossing] - cosine[crossing] * (y[1] - y[0]) / (cosine[crossing + 1] - cosine[crossing])
        period = 2 * (place[-1] - place[0]) / (len(place) - 1)
        # the wavefront of the beam that is turned meets the screen 0.4 m on: its own bend turns it by 4e-6 of the angle
        assert period == pytest.approx(WAVELENGTH / math.sin(2e-3 * tip), rel=2e-5)


@pytest.mark.parametrize(("shape", "line"), [
    ("gaussian", two_beams.gaussian_line), ("lorentzian", two_beams.lorentzian_line)
])  # fmt: skip
def test_visibility_falls_as_the_shape_of_the_line_says(shape: Any, line: Any) -> None:
    width, laser = 400.0, source(SpectralLine(width=400.0, shape=shape))
    for delta in (0.0, 60.0, 150.0, 290.0, 600.0):
        agree(laser, delta, lambda d: two_beams.visibility(line(width * 1e6), width * 1e6, d))


def test_two_modes_500_mhz_apart_lose_their_fringes_at_300_mm_and_have_them_back_at_600() -> None:
    laser = source(SpectralLine(center=-250.0), SpectralLine(center="250 MHz"))
    assert visibility_of(laser, MODE / 2) < 1e-6  # at 299.79 mm
    assert visibility_of(laser, 300.0) < 2e-3
    assert visibility_of(laser, MODE) == pytest.approx(abs(two_beams.overlap(WAIST, WAVELENGTH, MODE)), abs=1e-6)
    assert visibility_of(laser, 600.0) > 0.999
    for delta in (0.0, 40.0, 220.0, 300.0, 410.0, 600.0):
        agree(laser, delta, lambda d: math.cos(math.pi * d / MODE))


def test_lines_of_crossed_polarization_interfere_only_with_their_own() -> None:
    own = source(
        SpectralLine(center=-500.0, share=0.25, polarization=0.0), SpectralLine(share=0.5, polarization=90.0),
        SpectralLine(center=500.0, share=0.25, polarization=0.0),
    )  # fmt: skip
    for delta in (0.0, 100.0, MODE / 2, MODE):
        agree(own, delta, lambda d: 0.5 + 0.5 * math.cos(2 * math.pi * d / MODE))
    assert read(bench(own, {})) + read(bench(own, {}), "cam") == pytest.approx(1.0, abs=1e-6)


@settings(deadline=None, max_examples=12)
@given(st.floats(0, 310), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0, 10), st.floats(0, 2000))
def test_both_ports_add_up_to_one(stage: float, tip: float, tilt: float, piezo: float, width: float) -> None:
    laser = source(SpectralLine(center=-250.0, width=width), SpectralLine(center=250.0, width=width, share=0.3))
    meter = kind("power_meter")
    values = {"delay_stage_x": stage, "m3_tip": tip, "m3_tilt": tilt, "m2_piezo": piezo}
    found = bench(laser, values, cam=(meter, POSES["cam"]))
    assert read(found) + read(found, "cam") == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("piezo", [0.1, 0.2, 1.0])
def test_a_piezo_pushes_its_mirror_along_its_normal_towards_the_light(piezo: float) -> None:
    found = read(bench(source(), {"m2_piezo": piezo}))  # at 45 deg the way is shorter by the square root of 2 of that
    assert found == pytest.approx(expected(math.sqrt(2) * piezo * 1e-3, lambda _: 1.0), abs=1e-6)


@pytest.mark.parametrize("period", [0.04, 0.02375, 0.012, 0.005])  # mm; the grid's own is 0.02375
def test_fringes_too_fine_for_its_grid_add_nothing_to_a_meter(period: float) -> None:
    (one, *_), part = bench(source(), {}).at("meter"), kind("power_meter")
    angle = math.asin(WAVELENGTH / period)
    turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
    other = replace(one.beam, along=turn @ one.beam.along, across=turn @ one.beam.across)
    both = (one, replace(one, beam=other))
    assert part.number("active_diameter", "mm") == 400 * 0.02375
    assert power_on(both, one.part) == pytest.approx(2 * one.power, rel=1e-6)


def test_a_roof_sends_light_back_as_it_came_however_it_is_turned_and_tells_where_its_edge_is_hit() -> None:
    for yaw, aside in ((0.0, 10.0), (2.0, 10.0), (-3.0, -12.0)):
        poses = {"laser": Pose(100, 400), "roof": Pose(500, 400 - aside, yaw)}
        found = light({"laser": source(), "roof": kind("delay_stage")}, poses, {"roof": {"stage_x": 100.0}})
        back = found.crossings[-1].beam
        assert np.abs(back.along - [-1, 0, 0]).max() < 1e-12 and not back.unknown
        edge = Pose(500, 400 - aside, yaw).apply(-55, 0)
        assert back.at[1] == pytest.approx(2 * edge[1] - 400, abs=1e-9)
        assert back.power == pytest.approx(0.975**2)
        # from the exit to the plane through the edge across the light, and back to the housing beside the exit
        assert back.length == pytest.approx(2 * (edge[0] - 160), abs=1e-9)
    poses["roof"] = Pose(500, 400.5)
    assert (
        "edge of its roof" in light({"laser": source(), "roof": kind("delay_stage")}, poses).crossings[-1].beam.unknown
    )


@pytest.mark.parametrize("delta", [0.0, 200.0, 600.0])
def test_arms_of_other_lengths_overlap_as_far_as_their_gaussians_do(delta: float) -> None:
    narrow = source(waist_radius=0.3)
    overlap = abs(two_beams.overlap(0.3, WAVELENGTH, delta))
    assert visibility_of(narrow, delta) == pytest.approx(overlap, abs=1e-6)
    assert delta == 0 or overlap < 0.99


@pytest.mark.parametrize("angle", [0.0, 10.0, 22.5, 45.0])
def test_beams_interfere_by_the_cosine_between_their_polarizations(angle: float) -> None:
    plate = replace(kind("half_wave_plate", angle=90.0 + angle), tunables={})
    found = visibility_of(source(), 0.0, hwp=(plate, Pose(320, 420, 90)))
    assert found == pytest.approx(abs(math.cos(2 * math.radians(angle))), abs=1e-6)


@pytest.mark.parametrize(("delta", "tip"), [(0.0, 1.0), (1.5e-3, 0.4), (-4e-3, 1.5)])
def test_white_light_shows_its_fringes_where_the_paths_are_the_same(delta: float, tip: float) -> None:
    width = 150.0 * 299792458e9 / (WAVELENGTH * 1e6) ** 2  # of 150 nm around the carrier [Hz]
    picture, y, z = seen(bench(source(SpectralLine(width="150 nm")),
                               {"m3_tip": tip, "delay_stage_x": EQUAL + delta / 2}).at("cam"))  # fmt: skip
    sigma = width / math.sqrt(8 * math.log(2))
    offsets = np.linspace(-6, 6, 241)
    shares = np.exp(-(offsets**2) / 2) / np.exp(-(offsets**2) / 2).sum()
    both = arms(EQUAL + delta / 2, tip * 1e-3)
    fields = wanted(y, z, both, list(zip(offsets * sigma, shares, strict=True)))
    assert np.abs(picture - fields).max() < 1e-6 * fields.max()
    middle = picture[40]
    assert middle.max() > 1.2 * np.median(middle)


def test_a_wide_line_of_each_shape_agrees_with_the_degree_of_coherence_pixel_by_pixel() -> None:
    for shape in ("gaussian", "lorentzian"):
        lines = (SpectralLine(center="3 THz", width="20 THz", shape=shape), SpectralLine(center=-250.0, share=0.5))
        found = bench(source(*lines), {"m3_tip": 1.0})
        picture, y, z = seen(found.at("cam"))
        one, other = arms(tip=1e-3)
        place = 220 + 1j * (370 - y)[None, :]
        (a, far), (b, near) = (
            two_beams.field(arm, place, z[:, None], WAIST, WAVELENGTH, -1 + 0j) for arm in (one, other)
        )
        ((_, _, spectrum),) = spectra_of(found.parts["laser"].kind, 632.8)
        both = a * b.conj() * np.exp(2j * math.pi * (far - near) / WAVELENGTH) * degree(spectrum, far - near)
        fields = np.abs(a) ** 2 + np.abs(b) ** 2 + 2 * both.real
        assert np.abs(picture - fields).max() < 1e-6 * fields.max()


def test_white_light_through_glass_in_one_arm_is_unknown_and_a_laser_is_not() -> None:
    glass = (kind("neutral_density_filter", optical_density=0.0), Pose(320, 420, 90))
    lens = (kind("plano_convex_100", radius_of_curvature=51.5), Pose(320, 420, 90))
    white, narrow = source(SpectralLine(width="150 nm")), source(SpectralLine(width=1500.0))
    assert not out_of_step(bench(white, {}).at("cam"))
    assert not out_of_step(bench(white, {}, nd=glass).at("cam"))  # without a thickness it is thin
    assert not out_of_step(bench(narrow, {}, lens=lens).at("cam"))
    found = bench(white, {}, lens=lens)
    assert "dispersion" in out_of_step(found.at("cam"))
    setup = setup_of({name: part.kind for name, part in found.parts.items()})
    assert {d.address for d in troubles(setup, found) if d.code == "unknown-light"} == {"cam", "meter"}


@pytest.mark.parametrize("delta", [0.0, 240.0, MODE])
def test_frames_show_the_visibility_within_its_sigma(delta: float) -> None:
    laser = source(SpectralLine(center=-250.0), SpectralLine(center=250.0), power=0.002)
    stage, tip = EQUAL + delta / 2, 1.0
    found = bench(laser, {"m3_tip": tip, "delay_stage_x": stage, "cam_exposure": 1.0})
    part, sensor = found.parts["cam"], sensor_of(found.parts["cam"])
    modes = [(-250e6, 0.5), (250e6, 0.5)]
    fields = wanted(sensor.y, sensor.z, arms(stage, tip * 1e-3), modes)
    reference = two_beams.demodulated(fields, sensor.y, WAVELENGTH / 2e-3)
    off = []
    for number in range(4):
        counts = camera_frame(found.at("cam"), part, number=number)
        frame = Frame(counts, pixel_size=sensor.pitch, exposure=1.0, full_scale=sensor.full_scale,
                      black_level=sensor.black, electrons_per_count=sensor.electrons_per_count(0.0),
                      read_noise=sensor.read_noise)  # fmt: skip
        told = fringes.apply(frame, {})
        off.append((told.value["visibility"] - reference) / told.sigma["visibility"])
    assert np.abs(off).max() < 4 and abs(np.mean(off)) < 4 / math.sqrt(len(off))


def test_light_is_coherent_over_what_its_spectrum_says() -> None:
    """exp(-(pi w d)^2 / (4 ln 2)) of a Gaussian, exp(-pi w d) of a Lorentzian, cos(pi w d) of two modes, at 1/e."""
    for width in (0.01, 431.0):
        (gaussian, lorentzian) = ((None, 1.0, (Line(0.0, width, shape, 1.0),)) for shape in ("gaussian", "lorentzian"))  # type: ignore[arg-type]
        assert coherence_length([gaussian]) == pytest.approx(2 * math.sqrt(math.log(2)) / (math.pi * width), rel=0.06)
        assert coherence_length([lorentzian]) == pytest.approx(1 / (math.pi * width), rel=0.06)
    modes = tuple(Line(side / (2 * MODE), 0.0, "gaussian", 0.5) for side in (-1, 1))
    assert coherence_length([(None, 1.0, modes)]) == pytest.approx(MODE * math.acos(1 / math.e) / math.pi, rel=0.06)
    assert coherence_length([(None, 1.0, ())]) == math.inf
