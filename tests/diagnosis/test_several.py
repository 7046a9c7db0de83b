"""Several things that happen to the case study's bench at once: each is told, and nothing else is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from pico.diagnosis.causes import causes
from pico.diagnosis.choosing import Chosen, chosen, darks
from pico.diagnosis.nominal import Nominal, Step
from pico.diagnosis.quantities import Got
from pico.diagnosis.responses import denser
from pico.diagnosis.suspects import Compared, Verdict, suspects


@pytest.fixture(scope="module")
def what(nominal: Nominal) -> Chosen:
    return chosen(nominal)


def judged(nominal: Nominal, what: Chosen, steps: Sequence[Step], off: dict[str, float] | None = None) -> Verdict:
    """Return what is suspected after some changes, with noise as instruments have it, and some quantities `off`."""
    draw, compared = np.random.default_rng(1), []
    for one in (*what.quantities, *darks(nominal, ("cam",))):
        then, now = nominal.quantity(one), nominal.quantity(one, steps)
        if then is not None and now is not None:
            sigma = max(then.sigma, {"um": 0.1, "count": 0.01}.get(one.unit, 0.002))
            noise = sigma * draw.standard_normal(2)
            more = (off or {}).get(one.name, 0.0)
            compared.append(Compared(one, Got(then.value + noise[0], sigma), Got(now.value + noise[1] + more, sigma)))
    return suspects(nominal, compared, causes(nominal.setup, what.parts))


def told(found: Verdict) -> list[set[tuple[str, str]]]:
    """Return of each cause which parts may be it, with what befell them."""
    return [{(s.part, s.kind) for s in group} for group in found.causes]


def test_each_reading_of_a_scan_is_a_quantity(what: Chosen) -> None:
    null = next(q for q in what.quantities if q.name == "p1 null")
    single = [q for q in what.quantities if q.name.startswith("p1 null at ")]
    assert [q.shots for q in single] == [(shot,) for shot in null.shots]
    assert {(q.law, q.tunable) for q in single} == {("share", "p1.angle")}


@pytest.mark.slow
def test_a_plate_that_slipped_by_far_does_not_hide_a_little_dirt(nominal: Nominal, what: Chosen) -> None:
    """Two degrees from its null a scan of three points tells hardly where that is, and its readings still tell all."""
    found = judged(nominal, what, (Step("hwp", "zero:angle", 8.4), Step("p2", "loss", 0.07)))
    plate, dirt = sorted(told(found), key=len)
    assert plate == {("hwp", "zero of angle"), ("laser", "polarization")}, "a half-wave plate does what its light does"
    assert ("p2", "dirt") in dirt


@pytest.mark.slow
def test_a_leak_a_gain_and_a_retardance_are_told_and_no_dirt(nominal: Nominal, what: Chosen) -> None:
    steps = (Step("p2", "leak", 4.2), Step("cam", "gain", -0.37), Step("hwp", "retardance", -0.095))
    found = judged(nominal, what, steps)
    assert [group[0].part for group in found.causes if len(group) > 1] == []
    assert {pair for group in told(found) for pair in group} == {
        ("p2", "extinction"), ("cam", "gain"), ("hwp", "retardance")
    }  # fmt: skip
    assert max(abs(x) for x in found.left if math.isfinite(x)) < 4


def test_what_no_cause_explains_is_told_by_reading(nominal: Nominal, what: Chosen) -> None:
    few = tuple(q for q in what.quantities if q.name.startswith(("p2 null", "cam", "laser")))
    odd = next(q.name for q in few if q.name.startswith("p2 null at"))
    found = judged(nominal, replace(what, quantities=few), (Step("laser", "power", -0.3),), {odd: 0.5})
    names = [q.name for q in (*few, *darks(nominal, ("cam",)))]
    left = {name: abs(x) for name, x in zip(names, found.left, strict=True) if math.isfinite(x)}
    assert max(left, key=lambda name: left[name]) == odd and left[odd] > 5
    assert any(group[0].part == "laser" and group[0].kind == "power" for group in found.causes)


def test_a_change_between_traced_sizes_follows_a_cubic() -> None:
    sizes = (-1.0, -0.4, 0.0, 0.5, 1.0)
    rows = denser({s: np.array([s, s**2, math.nan if s > 0.9 else 0.0]) for s in sizes})
    for s, (line, square, dark) in rows.items():
        assert line == pytest.approx(s)
        assert square == pytest.approx(s**2, abs=0.06)
        assert dark == 0.0 or math.isnan(dark)
    assert set(sizes) <= rows.keys() and len(rows) == 4 * 6 + 1
