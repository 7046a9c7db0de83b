"""Parabolas, fibres, spectrometers, balanced detectors and spatial filters, against closed forms and plain sums."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from light_benches import kind, light, setup_of

from pico.model.pose import Pose
from pico.optics.axis import axis_of
from pico.optics.instruments import balanced_reading
from pico.optics.light import Light
from pico.optics.offsets import coupled
from pico.optics.spectrum import channels, density, middle, recorded

LASER = Pose(100, 400)  # its exit at x = 160
WAVELENGTH = 632.8e-6


def bench(
    name: str, at: Pose, values: dict[str, float] | None = None, laser: dict[str, object] | None = None,
    **parameters: object,
) -> Light:  # fmt: skip
    kinds = {"laser": kind("hene_laser", **(laser or {"waist_radius": 1.0, "waist_position": 240.0})),
             "x": kind(name, **parameters)}  # fmt: skip
    return light(kinds, {"laser": LASER, "x": at}, {"x": values or {}})


@given(st.floats(-4, 4), st.sampled_from([90.0, -90.0, 60.0, 120.0]), st.floats(30, 300))
def test_parallel_light_meets_in_the_focus_of_a_parabola(aside: float, fold: float, focal: float) -> None:
    found = bench("off_axis_parabola", Pose(400, 400 + aside), fold=fold, focal_length=focal)
    back = found.crossings[1].beam
    turned = math.radians(fold)
    focus = np.array([400 + focal * math.cos(turned), 400 + aside + focal * math.sin(turned), 70])
    start = back.at - (back.length - found.crossings[0].beam.length) * back.along
    away = focus - start
    assert np.linalg.norm(away - (away @ back.along) * back.along) < 1e-9 * focal


@given(st.sampled_from([90.0, -90.0, 60.0]), st.floats(30, 300))
def test_the_middle_of_a_parabola_is_no_astigmat(fold: float, focal: float) -> None:
    found = bench("off_axis_parabola", Pose(400, 400), fold=fold, focal_length=focal)
    came, back = found.crossings[0].beam, found.crossings[1].beam
    there = np.linalg.inv(np.linalg.inv(back.curvature) - (back.length - came.length) * np.eye(2)).real
    assert there == pytest.approx((came.curvature.real[0, 0] - 1 / focal) * np.eye(2), rel=1e-6, abs=1e-9)


def test_geometry_alone_folds_light_as_a_parabola_does() -> None:
    kinds, poses = {"laser": kind("hene_laser"), "x": kind("off_axis_parabola")}, {"laser": LASER, "x": Pose(400, 400)}
    axis, found = axis_of(setup_of(kinds), poses, "laser"), light(kinds, poses)
    ends = {(m.component, *np.round(m.at, 3)) for leg in axis.legs for m in leg.met[-1:]}
    assert ends == {(c.component, *np.round(c.beam.at, 3)) for c in found.crossings}


@given(st.floats(0.5, 1.5), st.floats(-600, 600), st.floats(-0.6, 0.6), st.floats(-0.02, 0.02))
def test_a_fibre_takes_what_the_overlap_of_fields_says(waist: float, away: float, aside: float, yaw: float) -> None:
    laser: dict[str, object] = {"waist_radius": waist, "waist_position": 240.0 + away}
    found = bench("fiber_coupler", Pose(400, 400 + aside, yaw), laser=laser, mode_radius=0.9, clear_diameter=40.0)
    (arrival,) = found.at("x")
    part, beam = found.parts["x"], arrival.beam
    _, left, up = part.axes
    y = np.linspace(-6, 6, 601)
    k = 2 * math.pi / WAVELENGTH
    points = part.origin + y[None, :, None] * left + y[:, None, None] * up - beam.at
    ahead, across = points @ beam.along, points @ beam.frame.T
    # to the point along the chief ray, first order in the tilt: exp(ik (z + r M r / 2))
    phase = ahead + np.einsum("...i,ij,...j", across, beam.curvature, across) / 2
    field, mode = np.exp(1j * k * phase), np.exp(-(y[None, :] ** 2 + y[:, None] ** 2) / 0.9**2)
    share = abs((field * mode).sum()) ** 2 / ((np.abs(field) ** 2).sum() * (mode**2).sum())
    assert coupled(part, beam) == pytest.approx(share, abs=2e-4)


@given(st.floats(3, 60), st.floats(-20, 20), st.floats(-20, 20))
def test_a_pinhole_takes_what_lies_beside_it(hole: float, y: float, z: float) -> None:
    """1 - exp(-2 a^2 / w^2) in the middle, w = wavelength f / (pi w0); beside it the same integral by a plain sum."""
    values = {"pinhole_y": y, "pinhole_z": z}
    found = bench("spatial_filter", Pose(400, 400), values, pinhole=hole, transmission=1.0, clear_diameter=30.0)
    spot = WAVELENGTH * 15 / math.pi / 1.0
    rings = (np.arange(400) + 0.5) * hole / 2000 / 400
    radius, angle = np.meshgrid(rings, np.linspace(0, 2 * math.pi, 240, endpoint=False))
    square = (radius * np.cos(angle) - y * 1e-3) ** 2 + (radius * np.sin(angle) - z * 1e-3) ** 2
    share = (radius * np.exp(-2 * square / spot**2)).sum() * (hole / 2000 / 400) * (2 * math.pi / 240)
    share *= 2 / (math.pi * spot**2)
    assert found.crossings[0].onward == pytest.approx(share, abs=2e-4)


def test_a_spatial_filter_widens_and_makes_parallel() -> None:
    found = bench("spatial_filter", Pose(400, 400), pinhole=60.0, transmission=1.0)
    assert found.crossings[0].onward > 0.999
    wide, _, _ = found.crossings[1].beam.widths
    assert wide == pytest.approx(50 / 15, rel=0.02) and not found.crossings[1].beam.unknown
    assert "diffraction" in bench("spatial_filter", Pose(400, 400), pinhole=5.0).crossings[1].beam.unknown


@pytest.mark.parametrize("name", ["hene_laser", "hene_laser_two_modes", "diode_laser", "white_light_source"])
def test_a_spectrometer_loses_no_power_and_finds_the_middle(name: str) -> None:
    kinds = {"laser": kind(name), "x": kind("spectrometer", active_diameter=30.0, clear_diameter=30.0)}
    found = light(kinds, {"laser": LASER, "x": Pose(400, 400)})
    part, arrivals = found.parts["x"], found.at("x")
    seen, at = density(arrivals, part), channels(part)
    lost = 0.02 if name == "white_light_source" else 1e-8
    assert float(seen.sum()) == pytest.approx(sum(a.power for a in arrivals), rel=lost)
    assert float(at @ seen / seen.sum()) == pytest.approx(arrivals[0].wavelength, abs=3 if lost > 1e-8 else 0.02)


def test_a_narrow_line_is_as_wide_as_the_instrument_and_its_error_bar_holds() -> None:
    found = bench("spectrometer", Pose(400, 400), {"exposure": 1.0}, {"power": 1.0, "waist_radius": 0.5})
    part, arrivals = found.parts["x"], found.at("x")
    channel = float(channels(part)[1] - channels(part)[0])
    wide = math.sqrt(8 * math.log(2) * (1.2**2 / (8 * math.log(2)) + channel**2 / 12))
    pulls = []
    for number in range(60):
        mean, width, of_mean, of_width = middle(*recorded(arrivals, part, number=number), part)
        pulls.append(((mean - 632.8) / of_mean, (width - wide) / of_width))
    assert (np.abs(np.mean(pulls, axis=0)) < 0.6).all()
    assert (np.std(pulls, axis=0) > 0.6).all() and (np.std(pulls, axis=0) < 1.5).all()


def test_nothing_stands_out_in_the_dark() -> None:
    found = bench("spectrometer", Pose(400, 400, 180))
    assert not found.at("x") and math.isnan(middle(*recorded((), found.parts["x"]), found.parts["x"])[0])


@pytest.mark.parametrize(("aside", "volts"), [(-10.0, 1.0), (10.0, -1.0)])
def test_a_balanced_detector_tells_left_from_right(aside: float, volts: float) -> None:
    laser: dict[str, object] = {"power": 1.0 / 4.2, "waist_radius": 0.4}
    found = bench("balanced_detector", Pose(400, 400 + aside), laser=laser)
    read = balanced_reading(found.at("x"), found.parts["x"])
    assert read.value == pytest.approx(volts, abs=5 * read.sigma + 1e-6) and not read.saturated


def test_what_both_diodes_take_is_rejected() -> None:
    kinds = {"a": kind("hene_laser", waist_radius=0.4), "b": kind("hene_laser", waist_radius=0.4),
             "x": kind("balanced_detector", noise=0.0)}  # fmt: skip
    found = light(kinds, {"a": Pose(100, 410), "b": Pose(100, 390), "x": Pose(400, 400)})
    read = balanced_reading(found.at("x"), found.parts["x"])
    assert read.value == pytest.approx(1e-3 * 0.42 * 1e4 * 1e-3, rel=1e-3)  # 30 dB below the 4.2 V of one


def test_between_the_diodes_there_is_nothing() -> None:
    found = bench("balanced_detector", Pose(400, 400), laser={"waist_radius": 0.4})
    assert found.crossings[0].clipped > 0.999


def test_what_rides_on_a_stage_moves_its_window() -> None:
    kinds = {"laser": kind("hene_laser"), "x": kind("translation_stage")}
    for x in (-12.5, 0.0, 12.5):
        found = light(kinds, {"laser": LASER, "x": Pose(400, 400)}, {"x": {"stage_x": x}})
        assert found.crossings[0].beam.at[0] == pytest.approx(400 + x)
