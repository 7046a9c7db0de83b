"""What a change of any size does, by a few traces of light: as tracing for that size itself has it."""

from __future__ import annotations

import pytest

from pico.diagnosis.causes import Way, causes
from pico.diagnosis.choosing import chosen
from pico.diagnosis.curves import Curve, bends
from pico.diagnosis.nominal import Nominal, Step


def way_of(nominal: Nominal, part: str, what: str) -> Way:
    return next(w for c in causes(nominal.setup, (part,)) for w in c.ways if w.what == what)


@pytest.mark.parametrize(
    ("part", "what", "size"),
    [("p1", "zero:angle", -1.41), ("p2", "zero:angle", 2.7), ("hwp", "zero:angle", 0.83), ("p1", "leak", 3.4)],
)
def test_a_curve_is_what_tracing_each_size_would_give(nominal: Nominal, part: str, what: str, size: float) -> None:
    way, wanted = way_of(nominal, part, what), chosen(nominal).quantities
    curve = Curve(nominal, part, way)
    found = curve.quantities(wanted, size)
    for one, value in zip(wanted, found, strict=True):
        traced, still = (nominal.quantity(one, steps) for steps in ((Step(part, what, size),), ()))
        assert traced and still
        off = {"um": 0.02, "": 4e-3}.get(one.unit, 2e-5)
        assert value == pytest.approx(traced.value, abs=off + 1e-3 * abs(traced.value - still.value)), one.name


def test_of_all_ways_turns_leaks_and_retardances_bend(nominal: Nominal) -> None:
    ways = [w for c in causes(nominal.setup, tuple(nominal.poses)) for w in c.ways]
    assert {w.what for w in ways if bends(w)} == {"zero:angle", "roll", "leak", "retardance"}
