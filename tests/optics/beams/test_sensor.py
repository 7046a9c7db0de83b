"""A camera's sensor has the statistics of one: shot and read noise, gain, saturation, patterns that stay."""

from __future__ import annotations

import math

import numpy as np
import pytest

from pico.kernels.frame import Frame
from pico.kernels.pipeline import parsed, run
from pico.model.simulated import SensorErrors
from pico.optics.sensing.noise import NORMAL, STEP, shot, unlit
from pico.optics.sensing.sensor import Sensor, frame

SENSOR = Sensor((400, 300), 3.45, name="cam", read_noise=2.5, dark_current=1.0, black=64.0)
ALL = SensorErrors(non_uniformity=0.01, hot_pixels=1e-4, fringes=0.03, flicker=0.01)


def flat(electrons: float, number: int = 0, errors: SensorErrors | None = None, **how: float) -> np.ndarray:
    """Return a frame of even light [counts]."""
    return frame(
        SENSOR, lambda first, last: np.full((last - first, 400), electrons, dtype=np.float32), exposure=10.0,
        errors=errors, seed=5, number=number, **how,
    ).astype(float)  # fmt: skip


def test_pairs_of_flat_frames_tell_the_gain_with_everything_wrong() -> None:
    """Photon transfer: the variance of a pair's difference over its mean is the gain, whatever pattern both have."""
    means, variances = [], []
    for n, electrons in enumerate((200, 600, 1500, 3000, 5000, 7000)):
        for pair in range(4):
            # what flickers is the light: the same factor brings both frames of a pair to the same mean
            one, two = (flat(electrons, 100 * n + 2 * pair + k, ALL) - SENSOR.black for k in (0, 1))
            mean = (one.mean() + two.mean()) / 2
            means.append(mean)
            variances.append((one * mean / one.mean() - two * mean / two.mean()).var() / 2)
    slope, _ = np.polyfit(means, variances, 1)
    assert 1 / slope == pytest.approx(SENSOR.electrons_per_count(0.0), rel=0.01)


@pytest.mark.parametrize("mean", [0.1, 3.0, 30.0, NORMAL - 0.1, NORMAL, 3000.0])
def test_electrons_have_mean_and_variance_of_their_mean(mean: float) -> None:
    count = 400_000
    drawn = shot(np.full(count, mean, dtype=np.float32), np.random.Generator(np.random.SFC64(7))).astype(float)
    assert drawn.mean() == pytest.approx(mean, abs=5 * np.sqrt(mean / count))
    assert drawn.var() == pytest.approx(mean, rel=5 * np.sqrt((2 + 1 / mean) / count))
    assert drawn.min() >= 0


def chi_squared(seen: np.ndarray, expected: np.ndarray) -> float:
    """Return chi-squared of counts, less its degrees of freedom, in its standard deviations; rare ones count as one."""
    often = expected >= 10
    seen, expected = (np.append(row[often], row[~often].sum()) for row in (seen, expected))
    freedom = len(expected) - 1
    return float((((seen - expected) ** 2 / np.maximum(expected, 1)).sum() - freedom) / np.sqrt(2 * freedom))


@pytest.mark.parametrize("mean", [0.01, STEP - 0.001, STEP, 1.19, 2.0, 7.3, NORMAL - 0.01])
def test_few_electrons_are_drawn_as_poisson_has_them(mean: float) -> None:
    count, number = 1_000_000, np.arange(90)
    drawn = shot(np.full(count, mean, dtype=np.float32), np.random.Generator(np.random.SFC64(2))).astype(int)
    chance = np.exp(number * np.log(mean) - mean - [math.lgamma(n + 1) for n in number])
    assert chi_squared(np.bincount(drawn, minlength=90), count * chance) < 4


def test_pixels_draw_by_themselves_what_is_lit_about_them() -> None:
    mean = np.tile(np.array([0.0, 0.1, 3.0, 39.0, 41.0, 900.0], dtype=np.float32), 100_000)
    drawn = shot(mean.reshape(1000, -1), np.random.Generator(np.random.SFC64(3))).reshape(-1, 6).astype(float)
    assert drawn.mean(axis=0) == pytest.approx(mean[:6], abs=5 * np.sqrt(900 / 100_000))
    assert drawn[:, 0].max() == 0
    assert np.abs(np.corrcoef(drawn[:, 1:].T) - np.eye(5)).max() < 5 / np.sqrt(100_000)


@pytest.mark.parametrize(("noise", "black"), [(0.95, 64.0), (0.2, 64.0), (3.7, 64.3), (30.0, 20.0), (0.0, 64.0)])
def test_what_no_electron_has_reached_reads_black_level_and_read_noise(noise: float, black: float) -> None:
    count = 4_000_000
    drawn = unlit(noise, black, 4095).draw(0, count, np.random.Generator(np.random.SFC64(4)))
    edges = (np.arange(400) + 0.5 - black) / max(noise, 1e-9) / math.sqrt(2)
    chance = np.diff([0.0, *((1 + math.erf(x)) / 2 for x in edges)])
    assert chi_squared(np.bincount(drawn, minlength=400), count * chance) < 4
    far = int((np.abs(drawn - black) > 5 * noise + 0.5).sum())  # what a cell of the look-up would cut off
    assert far <= 20 if noise else far == 0


def test_pixels_side_by_side_and_one_above_the_other_know_nothing_of_each_other() -> None:
    dark = flat(0.05) - flat(0.05).mean()
    for apart in (1, 2, 3, 4, 64 * 400, 65 * 400):
        row = dark.ravel()
        assert abs(np.mean(row[apart:] * row[:-apart])) / row.var() < 5 / np.sqrt(row.size)


@pytest.mark.parametrize("electrons", [0.0, 0.3, 5.0, 39.0, 45.0])
def test_faint_light_has_the_mean_and_variance_of_electrons_and_read_noise(electrons: float) -> None:
    counts, per = flat(electrons), SENSOR.electrons_per_count(0.0)
    mean = electrons + 0.01  # with what it fills by itself
    variance = (mean + 2.5**2) / per**2 + 1 / 12
    assert counts.mean() == pytest.approx(64 + mean / per, abs=5 * np.sqrt(variance / counts.size))
    assert counts.var() == pytest.approx(variance, rel=5 * np.sqrt(3 / counts.size))


def test_a_dark_frame_has_black_level_and_read_noise() -> None:
    dark = flat(0.0)
    per = SENSOR.electrons_per_count(0.0)
    assert dark.mean() == pytest.approx(SENSOR.black + 0.01 / per, abs=0.02)
    assert dark.std() == pytest.approx(np.sqrt((2.5**2 + 0.01) / per**2 + 1 / 12), rel=0.02)


def test_gain_multiplies_and_full_scale_ends_it() -> None:
    one, twice = flat(1000.0), flat(1000.0, gain=20 * np.log10(2))
    assert (twice - 64).mean() == pytest.approx(2 * (one - 64).mean(), rel=2e-3)
    assert flat(50_000.0).min() == flat(50_000.0).max() == SENSOR.full_scale


def test_the_same_seed_and_number_give_the_same_frame_and_others_other_noise() -> None:
    assert (flat(500.0, 3, ALL) == flat(500.0, 3, ALL)).all()
    assert (flat(500.0, 3, ALL) != flat(500.0, 4, ALL)).mean() > 0.5


def test_the_pattern_belongs_to_the_sensor_and_not_to_the_frame() -> None:
    steady = SensorErrors(non_uniformity=0.05, fringes=0.03)
    one, two = (sum(flat(7000.0, n, steady) for n in range(start, start + 8)) for start in (0, 50))
    assert np.corrcoef(one.ravel(), two.ravel())[0, 1] > 0.95
    other = Sensor((400, 300), 3.45, name="cam2", read_noise=2.5, black=64.0)
    third = frame(other, lambda a, b: np.full((b - a, 400), 7000, np.float32), exposure=10.0, errors=steady)
    assert abs(np.corrcoef(one.ravel(), third.ravel())[0, 1]) < 0.5


@pytest.mark.parametrize("electrons", [20.0, 3000.0])
def test_a_sensor_as_bad_as_can_be_written_still_gives_frames(electrons: float) -> None:
    worst = SensorErrors(non_uniformity=1.0, hot_pixels=1e-4, fringes=1.0, flicker=1.0)
    assert flat(electrons, 1, worst).max() > SENSOR.black
    deaf = flat(electrons, 1, SensorErrors(non_uniformity=1.0)) < SENSOR.black + 6
    assert deaf.mean() > 0.15  # as many as lie below 0: a normal number under -1 sigma


def test_with_everything_wrong_a_spot_is_where_it_is_to_a_tenth_of_a_pixel() -> None:
    big = Sensor((1200, 1000), 3.45, name="cam", read_noise=2.5, dark_current=1.0, black=64.0)
    away = []
    for number in range(4):
        x, y = (np.arange(1200) - 599.5 - 11.3) / 90, (np.arange(1000) - 499.5 + 7.9) / 90
        column, row = (7000 * np.exp(-2 * x**2)).astype(np.float32), np.exp(-2 * y**2).astype(np.float32)
        counts = frame(
            big, lambda a, b, c=column, r=row: r[a:b, None] * c, exposure=10.0, errors=ALL, seed=9, number=number
        )
        per = big.electrons_per_count(0.0)
        taken = Frame(counts, pixel_size=1.0, black_level=64.0, electrons_per_count=per, read_noise=2.5)
        found = run(parsed("image | centroid"), taken)
        away.append((found.value["x"] - 11.3, found.value["y"] - 7.9))
    assert np.abs(np.mean(away, axis=0)).max() < 0.1
