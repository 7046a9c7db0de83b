"""A few data, with outliers among them, tell their scatter and a ratio within the standard error that they claim."""

from __future__ import annotations

import math
import random
import statistics
from itertools import pairwise

import pytest

from pico.runs.robust import between, ratio, scatter

SEEDS = range(200)


def normal(seed: int, count: int, sigma: float = 1.0) -> list[float]:
    draw = random.Random(seed)
    return [draw.gauss(0.0, sigma) for _ in range(count)]


def within(pulls: list[float]) -> None:
    """Two of three within one standard error, nearly all within three, and none of it by being vague."""
    assert 0.55 < sum(abs(one) < 1 for one in pulls) / len(pulls) < 0.8
    assert sum(abs(one) < 3 for one in pulls) / len(pulls) > 0.96
    assert abs(statistics.fmean(pulls)) < 0.35


@pytest.mark.parametrize("count", [12, 40])
def test_a_scatter_is_found_within_its_standard_error(count: int) -> None:
    found = [scatter([normal(seed, count, 0.3), [5 + one for one in normal(-seed - 1, count, 0.3)]],
                     [[0.0] * count] * 2) for seed in SEEDS]  # fmt: skip
    within([(one.value - 0.3) / one.sigma for one in found if one])


def test_what_looking_adds_is_taken_off() -> None:
    many = 60
    found = [scatter([normal(seed, many, math.hypot(0.3, 0.2))], [[0.2] * many]) for seed in SEEDS]
    within([(one.value - 0.3) / one.sigma for one in found if one])


def test_less_than_what_looking_adds_is_nothing_that_may_be_a_little() -> None:
    found = scatter([normal(1, 60, 0.1)], [[0.2] * 60])
    assert found is not None and found.value == 0 and 0 < found.sigma < 0.1


def test_outliers_do_not_count() -> None:
    clean, odd = normal(3, 40), [*normal(3, 40), 30.0, -50.0]
    one, other = scatter([clean], [[0.0] * 40]), scatter([odd], [[0.0] * 42])
    assert one is not None and other is not None
    assert (other.outliers, other.count) == (2, one.count)
    assert other.value == pytest.approx(one.value)


def test_looks_tell_by_their_differences_whatever_drifts_or_jumps() -> None:
    pulls = []
    for seed in SEEDS:
        looks = [one + 0.01 * n + (20 if n > 25 else 0) for n, one in enumerate(normal(seed, 50))]
        found = between([[b - a for a, b in pairwise(looks)]])
        assert found is not None and found.outliers >= 1
        pulls.append((found.value - 1) / found.sigma)
    within(pulls)


def test_a_ratio_is_found_within_its_standard_error_and_a_stall_does_not_count() -> None:
    pulls = []
    for seed in SEEDS:
        draw = random.Random(seed)
        planned = [draw.uniform(2, 12) for _ in range(30)]
        took = [1.3 * p + draw.gauss(0, 0.2) for p in planned]
        found = ratio([*took, 300.0], [*planned, 5.0])
        assert found is not None and found.outliers >= 1
        pulls.append((found.value - 1.3) / found.sigma)
    within(pulls)


@pytest.mark.parametrize("few", [[], [1.0]])
def test_too_little_tells_nothing(few: list[float]) -> None:
    assert scatter([few], [[0.0] * len(few)]) is None and ratio(few, few) is None
    assert between([]) is None
