"""What shifts moments by more than noise does: an edge of the frame, rounding to whole counts, the shot noise of smear,
a curved background, defects on slopes and side by side. Each enters the deviation, or is left out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles.beam_pictures import BLACK, Beam, light, places, taken

from pico.kernels.frame import Frame
from pico.kernels.kernel import Result
from pico.kernels.pipeline import parsed, run

SHAPE = (420, 560)
X, Y = places(SHAPE)


def measured(text: str, frame: Frame) -> Result:
    return run(parsed(f"image | {text}"), frame)


def furthest(beam: Beam, frame: Frame, kernel: str) -> float:
    """Return how many deviations the worst number of a kernel is off."""
    truth = {"x": beam.x, "y": beam.y, "major": beam.major, "minor": beam.minor, "angle": beam.angle}
    found = measured(kernel, frame)
    assert found.value, found.unknown
    if beam.minor > 0.87 * beam.major:
        del truth["angle"]
    return max(abs(found.value[n] - truth[n]) / found.sigma[n] for n in truth.keys() & found.value.keys())


def quiet(counts: NDArray[np.float64], seed: int, noise: float = 0.15, black: float = BLACK) -> Frame:
    """Return the frame of a camera whose read noise is far below one count [count]."""
    rng = np.random.default_rng(seed)
    electrons = rng.poisson(np.maximum(counts, 0) * 25.0) / 25 + rng.normal(0, noise, counts.shape)
    pixels = np.clip(np.rint(electrons + black), 0, 1023).astype(np.uint16)
    return Frame(
        pixels, pixel_size=1.0, full_scale=1023, black_level=BLACK, electrons_per_count=25.0, read_noise=25 * noise
    )


@pytest.mark.parametrize("kernel", ["centroid", "d4sigma"])
@pytest.mark.parametrize("gap", [0.62, 0.68, 0.76, 0.9])
@pytest.mark.parametrize("angle", [0.0, 40.0])
def test_what_an_edge_takes_of_a_beam_is_in_its_deviation(kernel: str, gap: float, angle: float) -> None:
    across = np.hypot(90 * np.cos(np.radians(angle)), 60 * np.sin(np.radians(angle)))
    beam = Beam(90, 60, angle, x=SHAPE[1] / 2 - gap * across, y=3.3)
    assert furthest(beam, taken(light(beam, SHAPE), 1), kernel) < 3


@pytest.mark.parametrize("kernel", ["centroid", "d4sigma", "gaussian_fit"])
@pytest.mark.parametrize("peak", [300, 700])
def test_light_that_a_quiet_camera_rounds_away_is_in_the_deviation(kernel: str, peak: float) -> None:
    beam = Beam(110, 90, 30, peak=peak, x=10.3, y=-6.7)
    assert furthest(beam, quiet(light(beam, SHAPE), 1), kernel) < 3.5
    assert furthest(beam, quiet(light(beam, SHAPE) + 0.4 * (X > 20) - 0.3 * (Y > 0), 2), kernel) < 3.5


def test_rounding_costs_nothing_if_noise_spreads_each_pixel_over_several_counts() -> None:
    from pico.kernels.rounding import rounding
    from pico.kernels.start import found

    for frame, harmful in (
        (taken(light(Beam(64, 64), SHAPE), 1), False),
        (quiet(light(Beam(64, 64, peak=600), SHAPE), 1), True),
    ):
        start = found(frame)
        assert not isinstance(start, str)
        lost = rounding(frame, start.background, None, start.moments[:2], np.array([90.0, 90.0]))
        assert (lost is not None) == harmful


@pytest.mark.parametrize("shape", [(512, 640), (391, 577)])
def test_a_background_is_placed_by_pixels_if_blocks_leave_some_over(shape: tuple[int, int]) -> None:
    beam = Beam(66, 60, peak=2400, x=105.3, y=-80.7)
    x, y = places(shape)
    for seed in range(2):
        frame = taken(light(beam, shape) + 60 * (x / shape[1] + 0.5) + 60 * (y / shape[0] + 0.5), seed)
        assert furthest(beam, frame, "d4sigma") < 4
        assert furthest(beam, frame, "centroid") < 4


def test_smear_has_the_shot_noise_of_its_own_light() -> None:
    beam = Beam(64, 64, peak=2400, x=10.3, y=-6.7)
    smear = 0.03 * light(beam, SHAPE).max(axis=0)[None] + 0 * Y
    found = [measured("centroid", taken(light(beam, SHAPE) + smear, seed)) for seed in range(40)]
    off = [(f.value["y"] - beam.y) / f.sigma["y"] for f in found]
    assert np.sqrt(np.mean(np.square(off))) < 1.3


def test_a_background_that_is_cut_off_at_zero_is_in_the_deviation() -> None:
    beam = Beam(100, 80, 40, peak=1500, x=10.3, y=20.7)
    fall = light(beam, SHAPE) - 12 * ((X / SHAPE[1] + 0.5) ** 2 + (0.5 - Y / SHAPE[0]) ** 2)
    noise = np.random.default_rng(1).normal(0, 1.0, SHAPE)
    counts = np.random.default_rng(2).poisson(light(beam, SHAPE) * 5) / 5 - light(beam, SHAPE)
    pixels = np.clip(np.rint(fall + counts + noise + 10), 0, 4095).astype(np.uint16)
    frame = Frame(pixels, pixel_size=1.0, black_level=10, electrons_per_count=5.0, read_noise=5.0)
    assert furthest(beam, frame, "d4sigma") < 4 and furthest(beam, frame, "centroid") < 4


GOOD = taken(light(Beam(30, 26, peak=2400, x=10.3, y=-6.7), SHAPE), 1)


def stuck(frame: Frame, at: dict[tuple[int, int], float]) -> Frame:
    pixels = frame.pixels.copy()
    for place, reads in at.items():
        pixels[place] = reads
    return replace(frame, pixels=pixels)


@pytest.mark.parametrize(
    "at",
    [{(216, 282): 4095}, {(216, 282): 0}, {(211, 296): 1900, (212, 297): 0}, {(40, 50): 4095, (40, 51): 2000},
     {(40, 50): 900, (41, 50): 3000}, {(222, 284): 4095, (221, 284): 2900}],
    ids=["full on a slope", "dead on a slope", "two in the beam", "full and hot", "two hot", "full beside hot"],
)  # fmt: skip
def test_defects_on_a_slope_or_side_by_side_are_left_out(at: dict[tuple[int, int], float]) -> None:
    frame = stuck(GOOD, at)
    assert set(zip(*(n.tolist() for n in frame.defects), strict=True)) == set(at)
    for kernel in ("centroid", "d4sigma", "gaussian_fit"):
        found, good = measured(kernel, frame), measured(kernel, GOOD)
        assert not found.unknown
        for name, value in found.value.items():
            assert abs(value - good.value[name]) < 1.5 * good.sigma[name], (kernel, name)


def test_a_black_level_far_from_the_picture_hides_no_defect_and_makes_none() -> None:
    for black in (BLACK + 40.0, BLACK - 40.0):
        frame = replace(stuck(GOOD, {(40, 50): 900, (300, 200): 0}), black_level=black)
        assert set(zip(*(n.tolist() for n in frame.defects), strict=True)) == {(40, 50), (300, 200)}


@pytest.mark.parametrize("width", [3.0, 3.5, 5.0])
@pytest.mark.parametrize("long", [1.0, 2.5])
@pytest.mark.parametrize("at", [(0.5, 0.5), (0.0, 0.5), (0.0, 0.0), (0.3, 0.2)])
def test_a_beam_of_three_pixels_is_no_defect(width: float, long: float, at: tuple[float, float]) -> None:
    beam = Beam(width * long, width, peak=2400, x=30 + at[0], y=-20 + at[1])
    assert not len(taken(light(beam, SHAPE), 1).defects[0])


def test_a_dim_beam_whose_moments_do_not_settle_is_told_as_dim() -> None:
    beam = Beam(80, 70, peak=6)
    found = [measured("d4sigma", taken(light(beam, (1024, 1280)), seed)) for seed in range(6)]
    why = [f.unknown for f in found if f.unknown]
    assert why and all("the beam is dim: noise outweighs its second moments" in text for text in why)


def test_part_and_means_of_a_signal_are_those_of_the_whole() -> None:
    rng = np.random.default_rng(4)
    for dark in (None, 60 + rng.normal(0, 1, SHAPE)):
        frame = replace(stuck(GOOD, {(40, 50): 900, (300, 200): 0}), dark=dark)
        assert np.array_equal(frame.part(slice(30, 310), slice(20, 210)), frame.signal[30:310, 20:210])
        blocks = frame.signal.reshape(SHAPE[0] // 4, 4, SHAPE[1] // 4, 4).mean(axis=(1, 3))
        assert frame.means(4) == pytest.approx(blocks, abs=1e-2)
