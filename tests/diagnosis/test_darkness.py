"""Where light is lost: by what comes to which detector, and what the laser's own monitor says."""

from __future__ import annotations

from pico.diagnosis.darkness import NO_LIGHT, STOPS, darkened
from pico.diagnosis.nominal import Nominal
from pico.diagnosis.repairs import repair


def test_a_monitor_that_fell_tells_of_the_laser_and_of_nothing_else(nominal: Nominal) -> None:
    (found,) = darkened(nominal, {"cam"}, set(), {"laser": -9.0})
    assert (found.part, found.kind, found.probability) == ("laser", NO_LIGHT, 1.0)
    assert "shutter" in repair(nominal.setup, found, nominal.values)


def test_a_monitor_that_stands_clears_its_laser(nominal: Nominal) -> None:
    found = darkened(nominal, {"cam"}, set(), {"laser": 0.001})
    assert [s.part for s in found] == ["hwp", "p1", "lx_125", "p2", "ly_150", "cam"]
    assert {s.kind for s in found} == {STOPS} and {s.probability for s in found} == {1 / 6}
    assert "up to cam" in repair(nominal.setup, found[0], nominal.values)


def test_without_a_monitor_the_laser_is_one_of_them(nominal: Nominal) -> None:
    assert [s.part for s in darkened(nominal, {"cam"}, set(), {})][:2] == ["laser", "hwp"]


def test_what_lit_detectors_see_through_is_cleared(nominal: Nominal) -> None:
    assert darkened(nominal, {"cam"}, {"cam"}, {}) == ()
