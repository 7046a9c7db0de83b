"""Pictures with what real sensors add: smear, columns and taps that differ, stuck pixels, few pixels to a beam, light
beside it. A number is near the truth by its own sigma, or it is unknown and says why."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles.beam_pictures import Beam, light, places, taken

from pico.backends.ranging import FULL, Taken, next_exposure
from pico.backends.ranging import taken as ranged
from pico.kernels.frame import Frame
from pico.kernels.kernel import Result
from pico.kernels.pipeline import parsed, run

SHAPE = (420, 560)
BEAM = Beam(64, 64, peak=2400, x=10.3, y=-6.7)
X, Y = places(SHAPE)
KERNELS = ("d4sigma", "gaussian_fit", "centroid", "power")


def measured(text: str, frame: Frame) -> Result:
    return run(parsed(f"image | {text}"), frame)


def pulls(beam: Beam, counts: NDArray[np.float64], kernel: str, seeds: int = 3) -> dict[str, list[float]]:
    """How many sigmas each number is off, in a few pictures."""
    truth = {"x": beam.x, "y": beam.y, "major": beam.major, "minor": beam.minor,
             "power": beam.peak * np.pi * beam.major * beam.minor / 8}  # fmt: skip
    out: dict[str, list[float]] = {}
    for seed in range(seeds):
        found = measured(kernel, taken(counts, seed))
        assert not found.unknown, found.unknown
        for name in truth.keys() & found.value.keys():
            out.setdefault(name, []).append((found.value[name] - truth[name]) / found.sigma[name])
    return out


def streak(share: float) -> NDArray[np.float64]:
    """Smear of an interline CCD: each column has a share of its brightest pixel all along."""
    return share * light(BEAM, SHAPE).max(axis=0)[None]


COLUMNS = np.random.default_rng(5).normal(0, 20, SHAPE[1])[None]
SENSORS = {
    "smear of 0.5 %": streak(0.005), "smear of 3 %": streak(0.03), "columns": COLUMNS + 60, "rows": 8.0 * (Y > 40),
    "two taps": 25.0 * (X > 0), "taps, columns and smear": 25.0 * (X > 0) + COLUMNS + 60 + streak(0.02),
}  # fmt: skip


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("added", SENSORS.values(), ids=SENSORS)
def test_stripes_of_a_sensor_do_not_count_as_light(kernel: str, added: NDArray[np.float64]) -> None:
    for name, off in pulls(BEAM, light(BEAM, SHAPE) + added, kernel).items():
        assert max(map(abs, off)) < 4, (name, off)


@pytest.mark.parametrize("share", [0.005, 0.03])
def test_smear_does_not_widen_a_beam_by_a_percent(share: float) -> None:
    frame = taken(light(BEAM, SHAPE) + streak(share), 1)
    for kernel in ("d4sigma", "gaussian_fit"):
        found = measured(kernel, frame)
        assert found.value["major"] == pytest.approx(64, rel=0.01) and found.sigma["major"] < 0.64


def test_stripes_cost_nothing_where_there_are_none() -> None:
    """A clean picture has none: a background that is corrected without need would be noisier."""
    from pico.kernels.start import found

    for seed in range(20):
        start = found(taken(light(BEAM, SHAPE), seed))
        assert not isinstance(start, str) and start.stripes is None


@pytest.mark.parametrize("width", [3, 5, 8, 20])
@pytest.mark.parametrize("kernel", ["gaussian_fit", "d4sigma", "centroid"])
def test_a_beam_of_a_few_pixels_is_measured(width: int, kernel: str) -> None:
    small = Beam(width, width, peak=2400, x=30.3, y=-20.7)
    for name, off in pulls(small, light(small, SHAPE), kernel).items():
        assert max(map(abs, off)) < 4, (name, off)


def test_a_small_beam_is_found_beside_a_brighter_half_of_the_sensor() -> None:
    small = Beam(5, 5, peak=2400, x=-100.3, y=20.7)
    found = measured("gaussian_fit", taken(light(small, SHAPE) + 60.0 * (X > 0), 1))
    assert found.value["x"] == pytest.approx(-100.3, abs=0.05)


def test_too_few_pixels_are_why_a_width_is_unknown() -> None:
    tiny, dim = Beam(2, 2, peak=2400), Beam(5, 5, peak=25)
    assert "too few pixels to tell its width" in measured("gaussian_fit", taken(light(tiny, SHAPE), 1)).unknown
    assert "too few pixels to tell its width" in measured("d4sigma", taken(light(tiny, SHAPE), 1)).unknown
    assert measured("d4sigma", taken(light(dim, SHAPE), 3)).unknown.startswith("the beam is only")


def test_a_streak_that_no_column_or_row_explains_makes_the_width_unknown() -> None:
    slanted = 12 * np.exp(-8 * ((X * 0.5 + Y * 0.866) / 40) ** 2)
    found = measured("d4sigma", taken(light(BEAM, SHAPE) + slanted, 1))
    assert found.unknown.startswith("light beside the beam (a streak, a halo, a second beam)")
    power = measured("power", taken(light(BEAM, SHAPE) + slanted, 1))
    truth = BEAM.peak * np.pi * 64 * 64 / 8
    assert abs(power.value["power"] - truth) < 4 * power.sigma["power"] and power.sigma["power"] > 0.005 * truth


def stuck(frame: Frame, *at: tuple[int, int], reads: float = 4095) -> Frame:
    pixels = frame.pixels.copy()
    for row, column in at:
        pixels[row, column] = reads
    return replace(frame, pixels=pixels)


GOOD = taken(light(BEAM, SHAPE), 1)


@pytest.mark.parametrize("kernel", [*KERNELS, "light", "peak", "visibility"])
@pytest.mark.parametrize("reads", [4095, 900, 0])
def test_a_pixel_that_is_stuck_or_hot_or_dead_is_left_out_and_counted(kernel: str, reads: float) -> None:
    found, good = measured(kernel, stuck(GOOD, (40, 50), (216, 290), reads=reads)), measured(kernel, GOOD)
    assert found.unknown == good.unknown and dict(found.value) == pytest.approx(dict(good.value), rel=2e-3, abs=0.02)
    if not found.unknown and reads != 0:
        assert found.remark.startswith("2 defective pixels left out, at column and row (50, 40), (290, 216)")
        assert not good.remark


def test_saturation_counts_where_light_is_or_where_pixels_touch() -> None:
    assert stuck(GOOD, (40, 50)).saturated == 0
    assert stuck(GOOD, (40, 50), (40, 51)).saturated == 2
    bright = taken(light(replace(BEAM, peak=3900), SHAPE), 1)
    row, column = np.unravel_index(int(bright.pixels.argmax()), SHAPE)
    assert stuck(bright, (int(row), int(column))).saturated == 1
    assert "of 235200 pixels read 4095" in measured("centroid", stuck(bright, (int(row), int(column)))).unknown


def test_a_picture_of_nothing_but_stuck_pixels_is_dark_and_says_so() -> None:
    dark = stuck(taken(0 * light(BEAM, SHAPE), 1), (40, 50), (300, 200))
    assert measured("centroid", dark).unknown == (
        "there is no light above the background, but for 2 defective pixels left out, at column and row (50, 40), "
        "(200, 300)"
    )


@pytest.mark.parametrize(
    "frame", [GOOD, stuck(GOOD, (40, 50)), stuck(GOOD, (40, 50), (40, 51)), taken(1.7 * light(BEAM, SHAPE), 1)]
)
def test_auto_range_calls_a_picture_saturated_exactly_if_the_kernels_do(frame: Frame) -> None:
    seen = ranged(1.0, frame.pixels, frame.black_level, frame.full_scale)
    assert (seen.level > FULL) == bool(frame.refusal)
    if not frame.refusal:
        assert next_exposure(seen, (0.01, 100)) is None


def test_auto_range_lengthens_the_exposure_of_a_dim_picture_with_a_stuck_pixel() -> None:
    dim = stuck(taken(light(replace(BEAM, peak=300), SHAPE), 1), (40, 50))
    seen = ranged(1.0, dim.pixels, dim.black_level, dim.full_scale)
    assert seen == Taken(1.0, pytest.approx(0.08, abs=0.01)) and (next_exposure(seen, (0.01, 100)) or 0) > 5
