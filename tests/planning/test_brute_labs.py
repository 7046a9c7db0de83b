"""Small labs with fingers, from end to end, against a search through every order, slot and grasp yaw."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import pytest
from brute_labs import Best, Lab, cheapest
from checker import check
from fuzzing import plan_case
from random_labs import random_case

from pico.model.operation import Operation
from pico.model.plan import Plan

LIMIT = 400_000


@dataclass(frozen=True)
class Outcome:
    """What became of a lab: refused, or planned with so many stagings, moving something right or not, proven or not."""

    refused: bool
    staged: int = 0
    asides: bool = False
    proven: bool = True


def compared(seed: int, most: int) -> Outcome:
    """Plan the lab of a seed, and assert that nothing cheaper is possible, and that what is refused is impossible."""
    case = random_case(seed, least=3, most=most)
    made, lab = plan_case(case), Lab(case)
    best = cheapest(lab, asides=False, limit=LIMIT)
    asides = best is None
    best = best or cheapest(lab, asides=True, limit=LIMIT)
    assert made.errored == (best is None), (seed, [d.summary for d in made.diagnostics])
    if best is None:
        return Outcome(True)
    assert check(case.setup, case.seen, case.wanted, made, seed=seed, extensions=2) == []
    assert cost(lab, made) == best.cost, (seed, best)
    if not asides:
        assert_bound(lab, made, best)
    return Outcome(False, made.staging.count, asides, made.staging.proven)


def cost(lab: Lab, made: Plan) -> float:
    """What the moves of a plan cost, counted as the search counts."""
    moved = [o for o in made.operations if "from" in o.arguments and isinstance(o.arguments.get("to"), dict)]
    return sum(lab.price(i, p) for i, p in (_spot(lab, o) for o in moved))


def _spot(lab: Lab, operation: Operation) -> tuple[int, int]:
    i, to = lab.names.index(operation.component), operation.arguments["to"]
    near = [
        p
        for p, s in enumerate(lab.spots[i])
        if p and s.slot == to.get("slot") and abs(s.pose.x - to["pose"]["x"]) + abs(s.pose.y - to["pose"]["y"]) < 1e-5
    ]
    return i, next(p for p in near)


def assert_bound(lab: Lab, made: Plan, best: Best) -> None:
    """The bound on stagings holds, and is the number itself where the plan says that it is proven."""
    fewest = best if best.cost == best.moves else cheapest(lab, asides=False, limit=LIMIT, prices=False)
    assert fewest is not None
    least = fewest.moves - sum(not lab.right(i) for i in range(len(lab.names)))
    assert made.staging.lower_bound <= least <= made.staging.count
    assert not made.staging.proven or made.staging.count == least


def test_no_small_lab_can_do_with_fewer_stagings() -> None:
    found = [compared(seed, 5) for seed in range(1000, 1016)]
    assert sum(o.staged > 0 for o in found) > 4, "too easy to mean anything"


@pytest.mark.slow
def test_none_of_two_hundred_labs_can_do_with_fewer_stagings() -> None:
    found = [compared(seed, 6) for seed in range(2000, 2200)]
    kinds = Counter((o.refused, o.asides, o.staged > 0) for o in found)
    assert kinds[False, False, True] > 80 and kinds[True, False, False] > 5, "too easy to mean anything"
    assert sum(o.proven for o in found) >= 198
