"""What `pico morning` writes of a morning: every reading that differs, and what its causes leave unexplained."""

from __future__ import annotations

from dataclasses import replace

from cli.views.morning import data, text
from pico.bench.drifting.morning import Morning, Read
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
