"""The classical rearrangement problem from end to end: as few discs staged as an exhaustive search says."""

from __future__ import annotations

import random
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest
from checker import check
from disc_labs import disc_case, random_places, waits
from fuzzing import plan_case
from planning_benches import moves

sys.path.append(str(Path(__file__).resolve().parent.parent / "staging"))

from feedback_cases import all_to_move

from pico.model.plan import Plan, Staging
from pico.motion.arms import ArmMotion
from pico.planning.ordering import travel
from pico.planning.ordering.travel import MANY
from pico.staging.feedback import solve as fewest_staged
from pico.staging.sequencing import cuts
from pico.staging.sequencing.program import PRICINGS, CutProgram

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


@dataclass
class Counted:
    """How often the bound was asked for, cuts were looked for, and a linear program was solved."""

    bounds: int = 0
    cuts: int = 0
    programs: int = 0


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Counted:
    found = Counted()

    def counts(owner: Any, name: str, what: str) -> None:
        own = getattr(owner, name)

        def call(*given: Any) -> Any:
            setattr(found, what, getattr(found, what) + 1)
            return own(*given)

        monkeypatch.setattr(owner, name, call)

    counts(cuts, "cut_bound", "bounds")
    counts(cuts, "violated", "cuts")
    counts(CutProgram, "_priced", "programs")
    return found


def many(count: int) -> Plan:
    """Return the plan of a lab that discs fill to 0.4, all of which move."""
    rng, side = random.Random(f"{count} 0"), RADIUS * (3.1416 * count / 0.4) ** 0.5
    starts, goals = (random_places(rng, count, RADIUS, side) for _ in range(2))
    case = disc_case(RADIUS, side, starts, goals)
    made = plan_case(case, ArmMotion(case.setup))
    best = fewest_staged(all_to_move(waits(RADIUS, starts, goals))).count
    assert made.staging == Staging(count=best, lower_bound=best, proven=True)
    return made


def test_the_bound_of_many_moves_is_asked_for_once_and_stopped_early_it_is_lower_but_holds(
    counted: Counted, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = many(36)
    assert (counted.bounds, counted.cuts) == (1, MANY.rounds - 1)
    assert MANY.rounds <= counted.programs <= MANY.rounds * (1 + PRICINGS)
    monkeypatch.setattr(travel, "MANY", replace(MANY, pivots=1))
    before = counted.programs
    cut = many(36)
    assert (counted.bounds, counted.cuts, counted.programs) == (2, MANY.rounds - 1, before + 1)
    assert cut.operations == full.operations
    assert cut.bound is not None and full.bound is not None and cut.bound < full.bound <= full.makespan


@pytest.mark.slow
def test_two_hundred_moves_are_bounded_within_the_same_budget(counted: Counted) -> None:
    made = many(200)
    assert counted.bounds == 1 and counted.programs <= MANY.rounds * (1 + PRICINGS)
    assert made.bound is not None and 0.94 * made.makespan < made.bound < made.makespan


def test_places_that_just_touch_are_refused() -> None:
    # in the published instances touching discs do not block one another, on a table they do
    with pytest.raises(ValueError, match="touch"):
        disc_case(40.0, 400.0, [(100, 100)], [(180, 100)])
