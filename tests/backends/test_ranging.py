"""An exposure finds itself from dark and from saturated, within the camera's limits, in the frames that it may take."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.backends.ranging import GOOD, MOST, Taken, brightest, level_of, next_exposure

LIMITS = (0.02, 1000.0)


def ranged(brightness: float, start: float, limits: tuple[float, float] = LIMITS) -> list[Taken]:
    """Return the frames taken of light that gives `brightness` of full scale in a millisecond."""
    taken = [Taken(start, min(1.0, brightness * start))]
    while (wanted := next_exposure(taken[-1], limits)) is not None and len(taken) < 3 * MOST:
        taken.append(Taken(wanted, min(1.0, brightness * wanted)))
    return taken


@given(exposure=st.floats(0.1, 900.0), start=st.floats(*LIMITS))
def test_light_that_an_exposure_suits_is_found_from_any_other(exposure: float, start: float) -> None:
    taken = ranged(0.7 / exposure, start)
    assert GOOD[0] <= taken[-1].level <= GOOD[1]
    assert len(taken) <= MOST


@pytest.mark.parametrize(("brightness", "end"), [(0.0, 1000.0), (1e-6, 1000.0), (1e4, 0.02)])
def test_without_light_or_with_too_much_it_ends_at_a_limit(brightness: float, end: float) -> None:
    for start in (0.02, 5.0, 1000.0):
        taken = ranged(brightness, start)
        assert taken[-1].exposure == end and len(taken) <= MOST


@given(
    exposure=st.floats(1e-4, 1e3), level=st.floats(0, 1), low=st.floats(1e-4, 1.0), wide=st.floats(1.0, 1e4)
)  # fmt: skip
def test_what_it_asks_for_is_within_the_limits(exposure: float, level: float, low: float, wide: float) -> None:
    wanted = next_exposure(Taken(exposure, level), (low, low * wide))
    assert wanted is None or low <= wanted <= low * wide


def test_the_level_is_above_black_and_never_below_nothing() -> None:
    assert level_of(4095, 64, 4095) == 1 and level_of(64, 64, 4095) == 0 and level_of(60, 64, 4095) == 0


def test_a_hot_pixel_is_no_light() -> None:
    pixels = np.full((40, 50), 64, dtype=np.uint16)
    pixels[7, 9] = 4095
    assert brightest(pixels) == 64
    pixels[20:23, 30:33] = 2000
    assert brightest(pixels) == 2000


def test_an_exposure_in_seconds_is_found_as_well() -> None:
    taken = ranged(30.0, 1.0, (2e-5, 1.0))
    assert GOOD[0] <= taken[-1].level <= GOOD[1] and taken[-1].exposure < 0.03
