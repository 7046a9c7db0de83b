"""A measurement is data: written, read again, and compared only where that means something."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.model.measurement import (
    CONDITIONS,
    PEEKED,
    ArrayRef,
    Measurement,
    incomparable,
    measurement_from_json,
)
from pico.model.record import as_json, canonical

NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
NAMES = st.text("abcxyz_", min_size=1, max_size=6)
ARRAYS = st.builds(
    ArrayRef, sha256=st.just("0" * 64), size=st.integers(0), shape=st.lists(st.integers(0)).map(tuple), dtype=NAMES
)
MEASUREMENTS = st.builds(
    Measurement,
    component=NAMES,
    measurable=NAMES,
    value=st.none() | NUMBERS | NAMES | st.dictionaries(NAMES, NUMBERS),
    array=st.none() | ARRAYS,
    unit=NAMES,
    sigma=st.none() | NUMBERS | st.dictionaries(NAMES, NUMBERS),
    settings=st.dictionaries(NAMES, NUMBERS | NAMES | st.booleans()),
    time=NUMBERS,
    kernel=st.none() | NAMES,
    kernel_version=st.none() | NAMES,
    assured=st.sets(st.sampled_from(CONDITIONS)).map(sorted).map(tuple),
    not_assured=st.dictionaries(st.sampled_from(CONDITIONS), NAMES),
)


@given(MEASUREMENTS)
def test_it_is_read_as_it_was_written(measured: Measurement) -> None:
    assert measurement_from_json(json.loads(json.dumps(as_json(measured)))) == measured


@given(MEASUREMENTS, MEASUREMENTS)
def test_which_of_two_comes_first_does_not_matter(a: Measurement, b: Measurement) -> None:
    assert bool(incomparable(a, b)) == bool(incomparable(b, a))
    assert bool(incomparable(a, a)) == bool(a.not_assured)


POWER = Measurement(
    component="pd", measurable="voltage", value=1.2, unit="V", settings={"gain": "0 dB"}, kernel="mean",
    kernel_version="1", assured=("settled", "shutter"),
)  # fmt: skip


@pytest.mark.parametrize(
    ("other", "why"),
    [
        ({"value": 3.4, "time": 90.0, "sigma": 0.1}, ""),
        ({"component": "pd2"}, "one is of pd.voltage, the other of pd2.voltage"),
        ({"unit": "mV"}, "unit: V, then mV"),
        ({"kernel": None, "kernel_version": None}, "kernel: mean, then none; kernel version: 1, then none"),
        ({"kernel_version": "2"}, "kernel version: 1, then 2"),
        ({"settings": {"gain": "10 dB"}}, "gain: 0 dB, then 10 dB"),
        ({"settings": {}}, "gain: 0 dB, then none"),
        ({"assured": ("settled",)}, "assured of the first only: shutter"),
        (
            {"assured": ("settled",), "not_assured": {"shutter": "laser is closed"}},
            "not assured of the second: shutter (laser is closed)",
        ),
        (
            {"assured": (), "not_assured": {"settled": PEEKED, "shutter": PEEKED}},
            f"not assured of the second: settled ({PEEKED}); not assured of the second: shutter ({PEEKED})",
        ),
    ],
)
def test_what_differs_in_how_it_was_measured_is_not_compared(other: dict[str, Any], why: str) -> None:
    assert "; ".join(incomparable(POWER, replace(POWER, **other))) == why


def test_two_that_lack_the_same_are_not_compared_either() -> None:
    doubtful = replace(POWER, assured=("settled",), not_assured={"shutter": "laser is closed"})
    assert len(incomparable(doubtful, doubtful)) == 2


@pytest.mark.parametrize(
    ("data", "said"),
    [
        ({}, "no pico.measurement/v1"),
        (as_json(POWER) | {"schema": "pico.measurement/v9"}, "newer PICO"),
        (as_json(POWER) | {"component": 3}, "component"),
        (as_json(POWER) | {"not_assured": {"moonlight": "dark"}}, "not_assured.moonlight"),
    ],
)
def test_what_is_no_measurement_is_refused(data: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        measurement_from_json(data)


def test_what_a_later_version_adds_is_passed_over() -> None:
    assert measurement_from_json(as_json(POWER) | {"weather": "fair"}) == POWER


def test_units_stay_with_their_numbers_in_a_document_that_has_these_by_the_alphabet() -> None:
    spot = {"major": 900.0, "minor": 800.0, "angle": 12.0, "ellipticity": 0.9}
    found = Measurement(
        component="cam", measurable="width", value=spot, sigma=dict.fromkeys(spot, 0.1), unit="um, um, deg, 1",
        kernel="image | d4sigma",
    )  # fmt: skip
    again = measurement_from_json(json.loads(canonical(found)))
    assert again.numbers == found.numbers
    assert {name: unit for name, (_, _, unit) in again.numbers.items()} == {
        "major": "um", "minor": "um", "angle": "deg", "ellipticity": "1",
    }  # fmt: skip
