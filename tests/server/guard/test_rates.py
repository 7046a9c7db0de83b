"""How often somebody may ask: `burst` at once, `per_second` on the long run, and `burst` at most is saved up."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pico.server.guard import rates
from pico.server.guard.rates import Rate


def asked(rate: Rate, who: str, now: float, most: int = 1000) -> int:
    """How many requests are let through at a moment."""
    return next(n for n in range(most) if not rate.taken(who, now))


@pytest.mark.parametrize("quiet", [0.0, 1.0, 60.0, 3600.0, 1e9])
@pytest.mark.parametrize("burst", [1.0, 5.0, 20.0])
def test_a_client_that_was_quiet_saves_up_its_burst_and_no_more(quiet: float, burst: float) -> None:
    rate = Rate(per_second=2.0, burst=burst)
    assert rate.left("anna", 0.0) == burst and asked(rate, "anna", 0.0) == burst
    assert rate.left("anna", quiet) == min(burst, 2.0 * quiet)
    assert asked(rate, "anna", quiet) == min(burst, 2.0 * quiet)


@pytest.mark.parametrize(("after", "more"), [(0.0, 0), (0.49, 0), (0.5, 1), (0.99, 1), (1.0, 2), (2.5, 5), (9.0, 5)])
def test_an_empty_bucket_fills_up_again_by_the_clock(after: float, more: int) -> None:
    rate = Rate(per_second=2.0, burst=5.0)
    assert asked(rate, "anna", 100.0) == 5
    assert asked(rate, "anna", 100.0 + after) == more


def test_a_clock_that_goes_back_takes_and_gives_nothing() -> None:
    rate = Rate(per_second=2.0, burst=5.0)
    assert rate.taken("anna", 100.0) and rate.left("anna", 50.0) == 4.0
    assert rate.taken("anna", 50.0) and rate.left("anna", 50.5) == 4.0


def test_what_is_refused_costs_nothing() -> None:
    rate = Rate(per_second=1.0, burst=1.0)
    assert rate.taken("anna", 0.0)
    assert [rate.taken("anna", 0.25 * n) for n in range(1, 4)] == [False, False, False]
    assert rate.left("anna", 0.75) == 0.75 and rate.taken("anna", 1.0) and rate.left("anna", 1.0) == 0.0


def test_everybody_has_a_bucket_of_their_own() -> None:
    rate = Rate(per_second=1.0, burst=3.0)
    assert asked(rate, "anna", 0.0) == 3 == asked(rate, "ben", 0.0)
    assert rate.left("cleo", 0.0) == 3.0


def test_so_many_buckets_are_kept_and_who_asked_longest_ago_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    assert rates.KEPT == 10_000
    monkeypatch.setattr(rates, "KEPT", 2)
    rate = Rate(per_second=0.0, burst=2.0)
    for who in ("anna", "ben", "anna"):
        assert rate.taken(who, 0.0)
    assert rate.taken("cleo", 0.0), "ben asked longest ago"
    assert {who: rate.left(who, 0.0) for who in ("anna", "ben", "cleo")} == {"anna": 0.0, "ben": 2.0, "cleo": 1.0}
    assert not rate.taken("anna", 0.0), "an empty bucket is kept by asking in vain, too"
    assert rate.taken("dora", 0.0) and rate.left("anna", 0.0) == 0.0 and rate.left("cleo", 0.0) == 2.0


@given(st.lists(st.tuples(st.sampled_from(["anna", "ben"]), st.integers(0, 40)), max_size=60))
def test_no_time_sees_more_requests_than_burst_and_rate_allow(history: list[tuple[str, int]]) -> None:
    """The rule by itself: between any two moments at most `burst` and what the time between gives."""
    rate, now, granted = Rate(per_second=0.5, burst=3.0), 0.0, dict[str, list[float]](anna=[], ben=[])
    for who, quarters in history:
        now += quarters / 4
        if rate.taken(who, now):
            granted[who].append(now)
        for times in granted.values():
            for n, first in enumerate(times):
                assert len(times) - n <= 3 + Fraction(times[-1] - first) / 2
