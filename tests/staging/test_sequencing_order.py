"""The order found is legal, costs what it says, and no order is cheaper than the bound."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sequencing_cases import Instance, cheapest, instance, keeps

from examples import examples
from pico.staging.sequencing import Effort, Sequence, best_order

LITTLE = Effort(moves=2000, steps=0, rounds=6)
"""No exact search: local search and the bound from cuts."""


FULL = Effort()


def ask(case: Instance, limit: Effort = FULL) -> Sequence:
    return best_order(case.start, case.between, case.end, case.before, limit=limit)


@pytest.mark.parametrize("density", [0.0, 0.1, 0.3, 0.6])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 6, 7])
def test_small_problems_cost_exactly_what_the_best_of_all_orders_costs(count: int, density: float) -> None:
    for seed in range(12):
        case = instance(count, density, seed)
        found = ask(case)
        assert found.proven
        assert found.cost == found.lower_bound == cheapest(case)
        assert keeps(found.order, case.before)


def test_eight_operations_agree_as_well() -> None:
    for seed in range(8):
        case = instance(8, 0.15, seed)
        assert ask(case).cost == cheapest(case)


def test_ties_everywhere_are_no_trouble() -> None:
    for seed in range(20):
        case = instance(6, 0.2, seed, most=1)
        assert ask(case).cost == cheapest(case)


def test_without_the_exact_search_the_bound_is_still_below_every_order() -> None:
    for seed in range(60):
        case = instance(7, (0.0, 0.1, 0.3)[seed % 3], seed)
        found, best = ask(case, LITTLE), cheapest(case)
        assert found.lower_bound <= best + 1e-6
        assert found.cost >= best
        assert not found.proven or found.cost == best


@settings(max_examples=examples(60), deadline=None)
@given(st.integers(0, 24), st.floats(0, 1), st.integers(0, 10**6))
def test_precedence_is_kept_and_the_cost_is_that_of_the_order(count: int, density: float, seed: int) -> None:
    case = instance(count, density, seed)
    for limit in (Effort(moves=3000, steps=2_000_000, rounds=3), LITTLE):
        found = ask(case, limit)
        assert keeps(found.order, case.before)
        assert found.cost == case.tour.cost(found.order)
        assert found.lower_bound <= found.cost


def test_eighteen_operations_without_any_precedence_are_proven() -> None:
    assert ask(instance(18, 0.0, 1)).proven


def test_a_large_problem_is_bounded_from_both_sides() -> None:
    found = ask(instance(60, 0.0, 2, most=500), Effort(moves=50_000, rounds=3))
    assert 0 < found.lower_bound <= found.cost < 1.5 * found.lower_bound


def test_more_effort_is_never_worse() -> None:
    case = instance(50, 0.05, 3)
    costs = [ask(case, Effort(moves=0, rounds=0)).cost, ask(case, Effort(moves=30_000, rounds=0)).cost]
    assert costs[1] < costs[0]


def test_the_same_problem_has_the_same_answer() -> None:
    case = instance(40, 0.05, 4)
    limit = Effort(moves=20_000, rounds=2)
    assert ask(case, limit) == ask(case, limit)


def test_an_answer_that_every_version_of_python_must_give() -> None:
    case = instance(40, 0.05, 4)
    found = ask(case, Effort(moves=20_000, rounds=0))
    assert (found.cost, found.order[:8]) == (180.0, (4, 29, 7, 38, 35, 9, 21, 32))


def test_nothing_to_order() -> None:
    found = best_order([], [], [], [])
    assert (found.order, found.cost, found.lower_bound, found.proven) == ((), 0.0, 0.0, True)


@pytest.mark.parametrize(
    ("before", "message"),
    [([{1}, {0}], "wait for one another: 0, 1"), ([{0}, set()], "wait for one another"), ([{7}, set()], "0 to 1")],
)
def test_a_precedence_that_no_order_keeps_is_an_error(before: list[set[int]], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        best_order([1, 1], [[0, 1], [1, 0]], [1, 1], before)


def test_tables_that_do_not_fit_and_costs_that_are_none_are_errors() -> None:
    with pytest.raises(ValueError, match="same 2 operations"):
        best_order([1, 1], [[0, 1]], [1, 1], [set(), set()])
    with pytest.raises(ValueError, match="finite"):
        best_order([1, 1], [[0, float("nan")], [1, 0]], [1, 1], [set(), set()])


def test_an_order_to_begin_with_is_only_made_cheaper() -> None:
    gains = []
    for seed in range(4):
        case = instance(45, 0.05, seed)
        rough = ask(case, Effort(moves=3000, sweeps=0, rounds=0))
        limit = Effort(moves=0, rounds=0)
        fine = best_order(case.start, case.between, case.end, case.before, limit=limit, first=rough.order)
        assert keeps(fine.order, case.before)
        gains.append(rough.cost - fine.cost)
    assert min(gains) >= 0 and max(gains) > 0
