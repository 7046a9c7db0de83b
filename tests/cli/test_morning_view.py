"""What `pico morning` writes of a morning: every reading that differs, and what its causes leave unexplained."""

from __future__ import annotations

import re
from dataclasses import replace

from cli.views.light_back import suspected
from cli.views.morning import data, text
from pico.bench.drifting.morning import Morning, Read
from pico.diagnosis.doubt import POSSIBLE
from pico.diagnosis.grouping import Suspect

POWER = Suspect("laser", "power", 1.0, {"power": -0.3}, {"power": 0.01}, {"power": ""})
FOUND = Morning(
    "r1", "2026-01-02T08:00:00Z", 20.0, reference="2026-01-01T18:00:00Z", age=50400.0, causes=((POWER,),),
    repairs=("look at the supply of laser",), suspects=(POWER,), unusual=True, repair="look at the supply of laser",
)  # fmt: skip


def read(name: str, then: float, now: float, change: float, **more: float) -> Read:
    return Read(name, "share", "mW", then, now, 0.003, change, **more)  # type: ignore[arg-type]


def test_what_the_causes_leave_is_said_with_the_readings_that_they_leave_it_of() -> None:
    reads = (read("pm.power", 0.0, -0.3, -30.0, left=0.2), read("fc.power", 0.0, -2.0, -90.0, left=-66.2),
             read("iris half closed", 0.0, 0.1, 9.0, left=16.4))  # fmt: skip
    found = replace(FOUND, readings=reads, unexplained=("iris half closed", "fc.power"))
    said = " ".join(text(found).split())
    assert (
        "This cause leaves 66 σ of fc.power and 16 σ of iris half closed unexplained; something else changed as well."
        in said
    )
    assert data(found)["unexplained"] == ["iris half closed", "fc.power"]
    assert "unexplained" not in text(replace(FOUND, readings=reads[:1]))


def test_where_no_cause_was_found_the_readings_are_named_as_well() -> None:
    found = replace(FOUND, causes=(), repairs=(), suspects=(), readings=(read("fc.power", 0.0, 1.0, 80.0, left=80.0),),
                    unexplained=("fc.power",))  # fmt: skip
    assert "No change of known parts explains 80 σ of fc.power." in " ".join(text(found).split())


def test_a_reading_that_changed_as_a_moved_part_predicts_is_listed() -> None:
    follows = read("fc.power", 0.0, -0.7, 0.1, expected=-0.7)
    calm = read("pm.power", 0.0, 0.001, 0.1, expected=0.0)
    for unusual in (True, False):
        said = text(replace(FOUND, readings=(follows, calm), unusual=unusual))
        assert "fc.power" in said and "pm.power" not in said


def test_what_readings_do_not_tell_apart_has_one_probability_and_none_each() -> None:
    laser = Suspect("laser", "pointing", 0.49, {}, {}, {}, like=("cam", "ly_150", "lx_100"))
    cam = Suspect("cam", "moved across", 0.30, {}, {}, {}, like=("laser", "ly_150", "lx_100"))
    lens = Suspect("ly_150", "moved across", 0.12, {}, {}, {}, like=("laser", "cam", "lx_100"))
    plate = Suspect("hwp", "zero of angle", 0.08, {}, {}, {})
    for said in (text(replace(FOUND, causes=((laser, cam, lens, plate),))),
                 "\n".join(suspected((laser, cam, lens, plate)))):  # fmt: skip
        assert re.findall(r"(\d+) %", said) == ["91", "8"], said
        words = " ".join(said.split())
        assert "91 % one of these, which the readings do not tell apart: - laser: pointing" in words
        assert "- one of cam and ly_150, which nothing tells apart: moved across" in words
        assert "8 % hwp: zero of angle" in words and "No reading tells laser from lx_100," in words


def test_a_cause_that_readings_tell_from_the_others_keeps_its_probability() -> None:
    one = Suspect("p1", "zero of angle", 0.7, {}, {}, {})
    other = Suspect("p1", "leak", 0.25, {}, {}, {})
    assert re.findall(r"(\d+) %", text(replace(FOUND, causes=((one, other),)))) == ["70", "25"]


def test_without_a_reading_that_could_be_compared_nothing_is_said_to_be_sure() -> None:
    quiet = Suspect("", "nothing unusual", 0.9, {}, {}, {})
    missed = Read("pm.power", "share", "mW", None, 0.2, 0.003, None)
    said = text(replace(FOUND, unusual=False, causes=(), suspects=(quiet,), readings=(missed,)))
    assert "sure" not in said and "no reading could be compared" in said


def test_parts_that_may_have_changed_are_listed_whole_and_not_as_found_causes() -> None:
    parts = ("m1", "m2", "l1", "l2", "iris", "flip", "qwp", "fc", "pbs", "hwp")
    group = tuple(Suspect(p, POSSIBLE, 0.1, {}, {}, {}, tuple(other for other in parts if other != p)) for p in parts)
    reads = (read("fc.power", 0.0, -2.0, -90.0, left=-66.2),)
    found = replace(FOUND, causes=((POWER,), group), repairs=("look at the supply of laser", "check m1"),
                    readings=reads, unexplained=("fc.power",))  # fmt: skip
    said = " ".join(text(found).split())
    one_of = "m1, m2, l1, l2, iris, flip, qwp, fc, pbs and hwp"
    assert f"The readings are not explained; one or several of: {one_of}." in said
    assert "The likeliest combination of causes leaves 66 σ of fc.power unexplained." in said
    assert "100 % laser: power" in said and "10 %" not in said
