"""Fewest stagings where only what leaves can free what arrives: fewest vertices that meet every cycle of a digraph."""

from __future__ import annotations

import random

import pytest
from feedback_cases import acyclic, all_to_move, least_feedback, random_digraph

from pico.staging.feedback import Limit, solve


def check(seed: int) -> None:
    successors, weights, forbidden = random_digraph(random.Random(seed))
    answer = solve(all_to_move(successors, weights, forbidden))
    best = least_feedback(successors, weights, forbidden)
    assert answer.proven
    if best is None:
        assert answer.options is None
        around = {link[0] for link in answer.cycle}
        assert around <= forbidden
        assert not acyclic(around, [(u, v) for u in around for v in successors[u] if v in around])
        return
    assert answer.options is not None and not set(answer.staged) & forbidden
    assert answer.weight == pytest.approx(best) == pytest.approx(sum(weights[v] for v in answer.staged))
    assert answer.lower_bound == pytest.approx(best)
    assert left_acyclic(successors, answer.staged)


def left_acyclic(successors: list[list[int]], gone: tuple[int, ...]) -> bool:
    rest = [v for v in range(len(successors)) if v not in gone]
    return acyclic(rest, [(u, v) for u in rest for v in successors[u] if v in rest])


@pytest.mark.parametrize("first", range(0, 100, 25))
def test_random_graphs_agree_with_trying_every_set(first: int) -> None:
    for seed in range(first, first + 25):
        check(seed)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(100, 500, 50))
def test_more_random_graphs_agree_with_trying_every_set(first: int) -> None:
    for seed in range(first, first + 50):
        check(seed)


def large(seed: int, n: int, degree: float) -> list[list[int]]:
    rng = random.Random(seed)
    return [[v for v in range(n) if v != u and rng.random() < degree / n] for u in range(n)]


def test_the_heavier_of_two_stays() -> None:
    assert solve(all_to_move([[1], [0]], {0: 3.0})).staged == (1,)


def test_of_a_complete_graph_all_but_the_heaviest_go() -> None:
    n = 8
    answer = solve(all_to_move([[v for v in range(n) if v != u] for u in range(n)], {v: 1.0 + v for v in range(n)}))
    assert answer.staged == tuple(range(n - 1))


def test_a_forbidden_ring_is_shown() -> None:
    answer = solve(all_to_move([[1], [2], [0], [0]], forbidden={0, 1, 2}))
    assert answer.options is None and answer.proven
    assert {link[0] for link in answer.cycle} == {0, 1, 2}


def test_weights_are_above_zero() -> None:
    with pytest.raises(ValueError, match="above 0"):
        solve(all_to_move([[1], [0]], {0: 0.0}))


def test_without_work_the_answer_is_valid_and_the_bound_below_it() -> None:
    problem = all_to_move(successors := large(3, 50, 5.0))
    hasty, exact = solve(problem, Limit(solves=0)), solve(problem)
    assert exact.proven
    assert hasty.lower_bound <= exact.weight <= hasty.weight
    assert not hasty.proven and hasty.options is not None
    assert left_acyclic(successors, hasty.staged)


def test_the_same_problem_has_the_same_answer() -> None:
    problem = all_to_move(large(5, 50, 4.0))
    assert solve(problem) == solve(problem)
