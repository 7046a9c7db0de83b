"""Where light is lost: by what comes to which detector, and what the laser's own monitor says."""

from __future__ import annotations

import math

from pico.diagnosis.causes import causes
from pico.diagnosis.darkness import NO_LIGHT, STOPS
from pico.diagnosis.nominal import Nominal
from pico.diagnosis.quantities import FLICKER, Got, Quantity, Shot
from pico.diagnosis.repairs import repair
from pico.diagnosis.suspects import Compared, Verdict, suspects

PARTS = ("laser", "hwp", "p1", "lx_125", "p2", "ly_150", "cam")


def share(address: str, then: float, now: float, sigma: float = FLICKER) -> Compared:
    wanted = Quantity(address, (Shot(address),), address.partition(".")[2], "share")
    return Compared(wanted, Got(math.log(then), FLICKER), Got(math.log(now), sigma))


def judged(nominal: Nominal, *read: Compared) -> Verdict:
    return suspects(nominal, read, causes(nominal.setup, PARTS))


DARK = share("cam.power", 100.0, 1e-3, 0.5)


def test_a_monitor_that_fell_tells_of_the_laser_and_of_nothing_else(nominal: Nominal) -> None:
    ((first, *_),) = judged(nominal, DARK, share("laser.monitor", 2.0, 2e-4, 0.5)).causes
    assert first.part == "laser" and first.kind in (NO_LIGHT, "power") and first.like == ()
    assert "supply" in repair(nominal.setup, first, nominal.values)


def test_a_monitor_that_stands_clears_the_power_of_its_laser(nominal: Nominal) -> None:
    ((first, *others),) = judged(nominal, DARK, share("laser.monitor", 2.0, 2.0)).causes
    told = {s.part for s in (first, *others)} | set(first.like)
    assert {"hwp", "p1", "lx_125", "p2", "ly_150", "cam"} <= told
    assert not any(s.kind in (NO_LIGHT, "power") for s in (first, *others))
    stops = next(s for s in (first, *others) if s.kind == STOPS and s.part != "laser")
    assert "what stands in the beam" in repair(nominal.setup, stops, nominal.values)


def test_a_power_that_fell_and_a_monitor_that_stands_are_no_dead_laser(nominal: Nominal) -> None:
    ((first, *_),) = judged(nominal, share("cam.power", 100.0, 70.0), share("laser.monitor", 2.0, 2.0)).causes
    assert first.kind not in (NO_LIGHT, STOPS, "power")
