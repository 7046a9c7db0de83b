"""What raw replies mean: a number to the last character, or the reason why there is none."""

from __future__ import annotations

import re

import numpy as np
import pytest

from pico.base.reasons import REASONS
from pico.diagnostics import PicoError
from pico.drivers import judging


@pytest.mark.parametrize(("reply", "value"), [
    ("0.0012", 0.0012), ("1.2E-3", 0.0012), ("+1.200000000E-03\n", 0.0012), ("-5", -5.0), (".5", 0.5), ("5.", 5.0),
    ("0", 0.0), (" 1e3 ", 1000.0), ("-9.8E35", -9.8e35),
])  # fmt: skip
def test_numbers_of_the_standard_are_numbers(reply: str, value: float) -> None:
    found = judging.number(reply, "W")
    assert (found.value, found.unknown, found.unit, found.raw) == (value, None, "W", reply)


@pytest.mark.parametrize(("reply", "code"), [
    ("9.9E37", "over-range"), ("+9.9e+37", "over-range"), ("9.90000000E37", "over-range"), ("1E300", "over-range"),
    ("1E999", "over-range"), ("INF", "over-range"), ("Infinity", "over-range"), ("OVLD", "over-range"),
    ("-9.9E37", "under-range"), ("NINF", "under-range"), ("-INF", "under-range"),
    ("9.91E37", "no-number"), ("9.910000E+37", "no-number"), ("NaN", "no-number"), ("nan", "no-number"),
    ("", "garbled"), ("1_0", "garbled"), ("1,2", "garbled"), ("0x10", "garbled"), ("1.2.3", "garbled"),
    ("1.2E", "garbled"), ("E5", "garbled"), ("- 5", "garbled"), ("\u0661", "garbled"), ("1.2 mW", "garbled"),
    ('0,"No error"', "garbled"), ("1.2\x00", "garbled"), ("12;13", "garbled"), ("+-1", "garbled"),
])  # fmt: skip
def test_what_is_no_measurement_is_unknown_with_its_reason_and_never_a_number(reply: str, code: str) -> None:
    found = judging.number(reply, "W")
    assert (found.value, found.unknown) == (None, code)
    assert found.why and code in REASONS


def test_an_error_in_the_queue_and_a_number_beyond_the_limits_are_no_readings() -> None:
    assert judging.number("0.5", "W", failure='-222,"Data out of range"').unknown == "instrument-error"
    assert judging.number("0.5", "W", limits=(0.0, 0.2)).unknown == "out-of-limits"
    assert judging.number("0.5", "W", limits=(0.0, 0.5)).value == 0.5


@pytest.mark.parametrize(("reply", "entry"), [
    ('0,"No error"', ""), ('+0,"No error"', ""), ("0", ""), ("0, No error", ""), ('-113,"Undefined header"',) * 2,
    ("5", "5"),
])  # fmt: skip
def test_entries_of_an_error_queue(reply: str, entry: str) -> None:
    assert judging.failure(reply) == entry


@pytest.mark.parametrize("reply", ["0.0012", "", "No error", "1.2E-3", '00,"No error"', "00"])
def test_what_is_no_entry_of_an_error_queue_is_told(reply: str) -> None:
    with pytest.raises(ValueError, match="no entry"):
        judging.failure(reply)


@pytest.mark.parametrize(("reply", "who"), [
    ("Acme,M1,S42,1.2", ("Acme", "M1", "S42", "1.2")), ("Acme, M1, S42, 1.2\r\n", ("Acme", "M1", "S42", "1.2")),
    ("Acme Laser 500", ("", "Acme Laser 500", "", "")), ("Acme,M1", ("Acme", "M1", "", "")),
    ("Acme,M1,S42", ("Acme", "M1", "S42", "")), ("Acme,M1,S42,1.2,opt 7", ("Acme", "M1", "S42", "1.2,opt 7")),
    ('"Acme,M1,,1.2"', ("Acme", "M1", "", "1.2")),
])  # fmt: skip
def test_an_identity_has_one_field_to_many(reply: str, who: tuple[str, ...]) -> None:
    found = judging.identity(reply)
    assert (found.vendor, found.model, found.serial, found.firmware) == who


@pytest.mark.parametrize("reply", ["", "0.0012", "1.2E-3", "NaN", "12,13", "Ac\x00me,M1", "9.9E37"])
def test_a_number_is_no_identity(reply: str) -> None:
    with pytest.raises(ValueError, match="no identity"):
        judging.identity(reply)


@pytest.mark.parametrize(("reply", "on"), [("1", True), ("ON", True), ("on\n", True), ("0", False), ("OFF", False)])
def test_switches(reply: str, on: bool) -> None:
    assert judging.switched(reply) is on


@pytest.mark.parametrize("reply", ["", "2", "YES", "1.0", "10", "O"])
def test_what_is_neither_on_nor_off_is_told(reply: str) -> None:
    with pytest.raises(ValueError, match="none of"):
        judging.switched(reply)


def test_whole_and_hexadecimal_numbers_have_all_their_digits_and_no_others() -> None:
    assert (judging.whole("-12"), judging.hexadecimal("FFFFFFFE", 8, signed=True)) == (-12, -2)
    assert judging.hexadecimal("7FFFFFFF", 8, signed=True) == 2**31 - 1
    for reply in ("1.0", "1_0", "nan", "", "\u0661"):
        with pytest.raises(ValueError, match="no whole"):
            judging.whole(reply)
    for reply in ("FFFF", "+FFFFFFF", "0xFFFFFF", "FFFFFFFG", "FFFFFFFFF"):
        with pytest.raises(ValueError, match="8 hexadecimal"):
            judging.hexadecimal(reply, 8)


@pytest.mark.parametrize("said", [
    {"dtype": "float64", "shape": [2, 2]}, {"shape": [2, 2]}, {"dtype": "uint8"}, {"dtype": "uint8", "shape": [2, 3]},
    {"dtype": "uint8", "shape": [4]}, {"dtype": "uint8", "shape": [2, 2, 1]}, {"dtype": "uint8", "shape": "2x2"},
    {"dtype": "uint8", "shape": [-2, -2]}, {"dtype": ["uint8"], "shape": [2, 2]}, {"dtype": "uint16", "shape": [2, 2]},
    {"dtype": "uint8", "shape": [2, True, 2]},
])  # fmt: skip
def test_what_is_no_picture_is_told_in_words(said: dict[str, object]) -> None:
    with pytest.raises(PicoError) as told:
        judging.picture(said, bytes(4))
    assert told.value.diagnostics[0].code == "device-reply"
    assert "no picture" in told.value.diagnostics[0].summary


@pytest.mark.parametrize(
    ("taken", "why"),
    [
        (np.zeros((4, 6), np.float64), "its pixels are of type float64, not uint8 or uint16"),
        (np.zeros((6, 4), np.uint8), "it has 4 x 6 pixels, and the camera sends 6 x 4"),
        (np.zeros(24, np.uint8), "its shape is [24]"),
        (np.zeros((0, 0), np.uint8), "its shape is [0, 0]"),
        (np.zeros((4, 6, 4), np.uint8), "its shape is [4, 6, 4]"),
    ],
)
def test_what_a_library_gives_that_is_no_picture_of_the_camera_is_told(taken: np.ndarray, why: str) -> None:
    with pytest.raises(PicoError, match=re.escape(why)) as wrong:
        judging.pixels("cam", taken, 6, 4)
    assert wrong.value.diagnostics[0].address == "cam"
    good = np.arange(24, dtype=np.uint16).reshape(4, 6)
    assert np.array_equal(judging.pixels("cam", good, 6, 4), good)


def test_a_picture_that_was_sent_before_is_stale_and_a_count_may_begin_anew() -> None:
    numbers = judging.Counted()
    for number in (3, 4, 65535, 1, 2):
        numbers.require_newer("cam", number)
    for stale in (2, 1):
        with pytest.raises(PicoError) as wrong:
            numbers.require_newer("cam", stale)
        assert wrong.value.diagnostics[0].code == "stale"
    numbers.require_newer("cam", 2)  # one wrong number does not spoil those after it
    for none in (-1, 2.5, None, "3", True):
        with pytest.raises(PicoError):
            numbers.require_newer("cam", none)


def test_pictures_are_gray_or_in_color() -> None:
    assert judging.picture({"dtype": "uint8", "shape": [2, 3]}, bytes(range(6))).tolist() == [[0, 1, 2], [3, 4, 5]]
    assert judging.picture({"dtype": "uint16", "shape": [2, 1, 3]}, bytes(12)).dtype == np.uint16
