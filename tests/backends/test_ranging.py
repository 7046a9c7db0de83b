"""An exposure finds itself from dark and from saturated, within the camera's limits, in the frames that it may take."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.backends.ranging import DARK, GOOD, MOST, Taken, next_exposure, taken

LIMITS = (0.02, 1000.0)


def ranged(brightness: float, start: float, limits: tuple[float, float] = LIMITS) -> list[Taken]:
    """Return the frames taken of light that gives `brightness` of full scale in a millisecond."""
    frames = [Taken(start, min(1.0, brightness * start))]
    while (wanted := next_exposure(frames[-1], limits)) is not None and len(frames) < 3 * MOST:
        frames.append(Taken(wanted, min(1.0, brightness * wanted)))
    return frames


@given(exposure=st.floats(0.1, 900.0), start=st.floats(*LIMITS))
def test_light_that_an_exposure_suits_is_found_from_any_other(exposure: float, start: float) -> None:
    frames = ranged(0.7 / exposure, start)
    assert GOOD[0] <= frames[-1].level <= GOOD[1]
    assert len(frames) <= MOST


@pytest.mark.parametrize(("brightness", "end"), [(0.0, 1000.0), (1e-6, 1000.0), (1e4, 0.02)])
def test_without_light_or_with_too_much_it_ends_at_a_limit(brightness: float, end: float) -> None:
    for start in (0.02, 5.0, 1000.0):
        frames = ranged(brightness, start)
        assert frames[-1].exposure == end and len(frames) <= MOST


@given(
    exposure=st.floats(1e-4, 1e3), level=st.floats(0, 1), low=st.floats(1e-4, 1.0), wide=st.floats(1.0, 1e4)
)  # fmt: skip
def test_what_it_asks_for_is_within_the_limits(exposure: float, level: float, low: float, wide: float) -> None:
    wanted = next_exposure(Taken(exposure, level), (low, low * wide))
    assert wanted is None or low <= wanted <= low * wide


def level(pixels: np.ndarray) -> float:
    return taken(1.0, pixels.astype(np.uint16), 64, 4095).level


def test_the_level_is_above_black_and_never_below_nothing() -> None:
    assert level(np.full((40, 50), 4095)) == 1 and level(np.full((40, 50), 64)) == level(np.full((40, 50), 60)) == 0


def test_a_hot_pixel_is_no_light() -> None:
    pixels = np.full((40, 50), 64)
    pixels[7, 9] = 4095
    assert level(pixels) == 0
    pixels[20:23, 30:33] = 64 + 2016
    assert level(pixels) == pytest.approx(0.5, abs=0.01)


def test_noise_is_no_light() -> None:
    noise = np.random.default_rng(1).normal(6, 1.5, (1024, 1280)).clip(0, 255).round().astype(np.uint8)
    assert taken(1.0, noise, 6.0, 255.0).level < DARK


def test_an_exposure_in_seconds_is_found_as_well() -> None:
    frames = ranged(30.0, 1.0, (2e-5, 1.0))
    assert GOOD[0] <= frames[-1].level <= GOOD[1] and frames[-1].exposure < 0.03
