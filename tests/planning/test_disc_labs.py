"""The classical rearrangement problem from end to end: as few discs staged as an exhaustive search says."""

from __future__ import annotations

import random
from collections.abc import Sequence
from itertools import combinations

import pytest
from checker import check
from disc_labs import disc_case, random_places, waits
from fuzzing import plan_case
from planning_benches import moves

from pico.model.plan import Staging

RADIUS = 40.0


def fewest(successors: Sequence[Sequence[int]]) -> int:
    """The least number of vertices without which there is no cycle, by looking at all sets, small ones first."""
    every = range(len(successors))
    sizes = (k for k in every for gone in combinations(every, k) if _acyclic(successors, set(gone)))
    return next(sizes)


def _acyclic(successors: Sequence[Sequence[int]], gone: set[int]) -> bool:
    left = set(range(len(successors))) - gone
    while sinks := {v for v in left if not left.intersection(successors[v])}:
        left -= sinks
    return not left


def compared(seed: int, count: int, density: float) -> int:
    rng = random.Random(seed)
    side = RADIUS * (3.1416 * count / density) ** 0.5
    starts, goals = (random_places(rng, count, RADIUS, side) for _ in range(2))
    case = disc_case(RADIUS, side, starts, goals)
    made = plan_case(case)
    best = fewest(waits(RADIUS, starts, goals))
    assert made.staging == Staging(count=best, lower_bound=best, proven=True), seed
    assert len(moves(made)) == count + best
    assert check(case.setup, case.seen, case.wanted, made, seed=seed, extensions=2) == []
    return best


def test_as_few_discs_are_staged_as_can_be() -> None:
    assert sum(compared(seed, 12, 0.42) for seed in range(10)) > 10, "too easy to mean anything"


@pytest.mark.slow
def test_as_few_of_many_discs_are_staged_as_can_be() -> None:
    staged = [compared(100 + seed, 22, 0.44) for seed in range(12)]
    assert max(staged) >= 4


def test_places_that_just_touch_are_refused() -> None:
    # in the published instances touching discs do not block one another, on a table they do
    with pytest.raises(ValueError, match="touch"):
        disc_case(40.0, 400.0, [(100, 100)], [(180, 100)])
