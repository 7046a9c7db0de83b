"""Kernels on pictures whose truth is known: how near they come, and whether they know how near. The bars are those of
the table in benchmarks/kernels.py, which has frames of a whole camera."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from statistics import median

import numpy as np
import pytest
from oracles.beam_pictures import Beam, fringe_picture, light, picture, taken

from pico.kernels.frame import Frame
from pico.kernels.kernel import Result
from pico.kernels.pipeline import parsed, run

SHAPE = (400, 480)
ROUND = Beam(80, 80, x=10.3, y=-6.7)
LONG = Beam(90, 55, 30, x=10.3, y=-6.7)


def measured(text: str, frame: Frame) -> Result:
    return run(parsed(f"image | {text}"), frame)


def truth(beam: Beam) -> Mapping[str, float]:
    power = beam.peak * np.pi * beam.major * beam.minor / 8
    return {
        "x": beam.x, "y": beam.y, "major": beam.major, "minor": beam.minor, "angle": beam.angle, "peak": beam.peak,
        "ellipticity": beam.minor / beam.major, "power": power,
    }  # fmt: skip


def middling(kernel: str, beam: Beam, off: Callable[[Mapping[str, float]], float]) -> float:
    return median(off(measured(kernel, picture(beam, SHAPE, seed)).value) for seed in range(5))


@pytest.mark.parametrize(
    ("beam", "pixels"), [(ROUND, 0.01), (LONG, 0.01), (replace(ROUND, tilt=10), 0.15)], ids=["round", "long", "tilt"]
)
def test_a_centroid_lies_where_the_beam_is(beam: Beam, pixels: float) -> None:
    assert middling("centroid", beam, lambda v: max(abs(v["x"] - beam.x), abs(v["y"] - beam.y))) < pixels


@pytest.mark.parametrize("kernel", ["d4sigma", "gaussian_fit"])
@pytest.mark.parametrize("beam", [ROUND, LONG], ids=["round", "long"])
def test_widths_are_those_of_the_beam(kernel: str, beam: Beam) -> None:
    assert middling(kernel, beam, lambda v: abs(v["major"] / beam.major - 1)) < 1e-3
    assert middling(kernel, beam, lambda v: abs(v["minor"] / beam.minor - 1)) < 1e-3


@pytest.mark.slow
def test_widths_of_a_dim_beam_on_a_whole_camera_are_good_to_a_fifth_of_a_percent() -> None:
    beam = Beam(500, 500, x=30.3, y=-20.7, peak=150)
    found = [measured("d4sigma", picture(beam, (2048, 2448), seed)).value["major"] for seed in range(3)]
    assert abs(median(found) / beam.major - 1) < 2e-3


@pytest.mark.parametrize("kernel", ["centroid", "d4sigma", "gaussian_fit", "power"])
@pytest.mark.parametrize("beam", [LONG, replace(LONG, peak=120)], ids=["bright", "dim"])
def test_a_kernel_knows_how_far_it_is_off(kernel: str, beam: Beam) -> None:
    found = [measured(kernel, picture(beam, (240, 320), seed)) for seed in range(60)]
    for name, true in truth(beam).items():
        if name in found[0].value:
            pulls = [(f.value[name] - true) / f.sigma[name] for f in found]
            assert 0.7 < np.sqrt(np.mean(np.square(pulls))) < 1.35, (name, np.mean(pulls), np.std(pulls))


def test_the_angle_runs_counter_clockwise_and_y_runs_up() -> None:
    pixels = np.zeros((100, 100))
    for step in range(-10, 11):
        pixels[28 - step : 33 - step, 60 + step] = 100.0  # from the lower left to the upper right
    frame = Frame(pixels, pixel_size=2.0)
    assert 44 < measured("d4sigma", frame).value["angle"] < 50
    assert measured("centroid", frame).value == pytest.approx({"x": 2 * 10.5, "y": 2 * 19.5}, abs=1e-3)


def test_power_is_the_same_whatever_exposure_and_gain() -> None:
    once = picture(LONG, SHAPE, 1)
    longer = replace(taken(light(LONG, SHAPE) * 0.5, 2), exposure=0.25, gain=20 * np.log10(2))
    assert measured("power", longer).value["power"] == pytest.approx(measured("power", once).value["power"], rel=2e-3)


@pytest.mark.parametrize(
    "text", ["centroid", "d4sigma", "gaussian_fit", "power", "peak", "visibility", "background | centroid",
             "mode_overlap(radius=40)"],
)  # fmt: skip
def test_a_saturated_picture_says_nothing_but_how_many_pixels_are(text: str) -> None:
    frame = picture(replace(ROUND, peak=4200), SHAPE, 1)
    full = int((frame.pixels == 4095).sum())
    found = measured(text, frame)
    assert full > 0 and not found.value and found.unknown == f"{full} of {400 * 480} pixels read 4095"
    assert measured("saturation", frame).value == {"saturated": full}


def test_pixels_that_overflow_below_full_scale_are_full() -> None:
    bright = picture(replace(ROUND, peak=3900), SHAPE, 1)
    assert bright.pixels.max() < 4095 and not bright.saturated
    cut = replace(bright, pixels=np.minimum(bright.pixels, 2600))
    full = int((cut.pixels == 2600).sum())
    assert cut.saturated == full
    assert measured("power", cut).unknown == f"{full} of {400 * 480} pixels read 2600"


@pytest.mark.parametrize("text", ["centroid", "d4sigma", "gaussian_fit", "background | centroid"])
def test_where_there_is_no_light_nothing_is_made_up(text: str) -> None:
    found = [measured(text, picture(replace(ROUND, peak=0), SHAPE, seed)) for seed in range(5)]
    assert {f.unknown for f in found} == {"there is no light above the background"}


@pytest.mark.parametrize("kernel", ["power", "peak"])
def test_no_light_is_a_number_with_its_deviation(kernel: str) -> None:
    found = [measured(kernel, picture(replace(ROUND, peak=0), SHAPE, seed)) for seed in range(40)]
    off = [f.value[kernel] / f.sigma[kernel] for f in found]
    assert not any(f.unknown for f in found) and max(map(abs, off)) < 6
    if kernel == "power":
        assert 0.7 < np.sqrt(np.mean(np.square(off))) < 1.35
        faint = np.pi * 80 * 80 / 8  # a beam of one count at its peak
        assert found[0].sigma["power"] < faint / 5


@pytest.mark.parametrize("text", ["centroid", "d4sigma", "power"])
def test_a_spot_at_the_edge_is_unknown_and_the_edge_is_named(text: str) -> None:
    found = measured(text, picture(Beam(80, 80, x=220), SHAPE, 1))
    assert not found.value and found.unknown.startswith("the spot leaves the frame at the right")


@pytest.mark.parametrize("dtype", [np.uint8, np.int32, np.float32, np.float64, bool])
def test_pixels_may_be_of_any_real_type(dtype: type) -> None:
    dim = picture(replace(ROUND, peak=120), SHAPE, 1)
    pixels = (dim.pixels > 124) if dtype is bool else dim.pixels.astype(dtype)
    found = measured("centroid", replace(dim, pixels=pixels, black_level=0.0))
    assert found.value["x"] == pytest.approx(ROUND.x, abs=1)


def test_pixels_that_are_no_numbers_are_no_value() -> None:
    pixels = picture(ROUND, SHAPE, 1).pixels.astype(float)
    pixels[3, 4] = np.nan
    assert measured("centroid", Frame(pixels)).unknown == "some pixels are no numbers"


def test_a_dark_frame_stands_for_the_black_level() -> None:
    frame = picture(ROUND, SHAPE, 1)
    lifted = np.linspace(0, 40, 480)[None] * np.ones((400, 1))
    uneven = replace(frame, pixels=frame.pixels + lifted, dark=64 + lifted, black_level=0.0)
    assert measured("centroid", uneven).value == pytest.approx(measured("centroid", frame).value, abs=2e-3)


def test_the_visibility_of_fringes_is_that_of_the_light() -> None:
    found = [measured("visibility", fringe_picture(0.6, (240, 320), seed)) for seed in range(40)]
    for name, true in (("visibility", 0.6), ("period", 17.3), ("angle", 20.0)):
        off = np.array([f.value[name] - true for f in found])
        assert 0.7 < np.sqrt(np.mean((off / [f.sigma[name] for f in found]) ** 2)) < 1.35, name
    assert max(abs(f.value["visibility"] - 0.6) for f in found) < 0.0035


def test_a_beam_without_fringes_has_none() -> None:
    assert measured("visibility", picture(ROUND, SHAPE, 1)).unknown.startswith("there are no fringes")


@pytest.mark.parametrize("apart", [1.2, 1.6, 2.0])
@pytest.mark.parametrize("middle", [(240, 200), (150, 140), (330, 150)])
def test_two_spots_side_by_side_are_no_fringes(apart: float, middle: tuple[int, int]) -> None:
    """Their transform goes up and down, too, wherever on the sensor they are: its skirt is no line."""
    y, x = np.mgrid[:400, :480]
    radius, (at, up) = 40.0, middle
    spots = sum(
        np.exp(-2 * ((x - at - side * apart * radius / 2) ** 2 + (y - up) ** 2) / radius**2) for side in (-1, 1)
    )
    frame = picture(ROUND, SHAPE, 1)
    found = measured("visibility", replace(frame, pixels=64 + 900 * spots))
    assert found.unknown or found.value["visibility"] < 0.05
    found = measured("visibility", replace(frame, pixels=64 + 900 * spots * (1 + 0.3 * np.cos(2 * math.pi * x / 17))))
    assert found.value["visibility"] == pytest.approx(0.3, abs=0.02)
    assert found.value["period"] == pytest.approx(17 * frame.pixel_size, rel=0.02)


@pytest.mark.parametrize("x", [0.0, 12.0])
def test_a_mode_takes_of_a_gaussian_beam_what_the_overlap_integral_says(x: float) -> None:
    # Two Gaussian fields of radii a, b a distance x apart: (2ab/(a^2+b^2))^2 exp(-2 x^2/(a^2+b^2)).
    a, b = 40.0, 50.0
    found = measured(f"mode_overlap(radius={b}, x={x})", picture(Beam(2 * a, 2 * a), SHAPE, 1))
    true = (2 * a * b / (a * a + b * b)) ** 2 * np.exp(-2 * x * x / (a * a + b * b))
    assert found.value["overlap"] == pytest.approx(true, abs=2e-3)
    assert abs(found.value["overlap"] - true) < 4 * found.sigma["overlap"]
