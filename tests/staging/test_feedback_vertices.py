"""Fewest vertices that meet every cycle."""

from __future__ import annotations

import random

import pytest
from feedback_cases import acyclic, least_feedback, random_digraph

from pico.staging.feedback import Limit, fewest_vertices


def check(seed: int) -> None:
    successors, weights, forbidden = random_digraph(random.Random(seed))
    answer = fewest_vertices(successors, weights, forbidden)
    best = least_feedback(successors, weights, forbidden)
    assert answer.proven
    if best is None:
        assert answer.vertices is None
        assert set(answer.cycle) <= forbidden
        following = answer.cycle[1:] + answer.cycle[:1]
        assert all(v in successors[u] for u, v in zip(answer.cycle, following, strict=True))
        return
    assert answer.vertices is not None and not set(answer.vertices) & forbidden
    assert answer.weight == pytest.approx(best) == pytest.approx(sum(weights[v] for v in answer.vertices))
    assert answer.lower_bound == pytest.approx(best)
    rest = [v for v in range(len(successors)) if v not in answer.vertices]
    assert acyclic(rest, [(u, v) for u in rest for v in successors[u] if v in rest])


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


def test_two_that_change_places_cost_one_staging() -> None:
    answer = fewest_vertices([[1], [0]])
    assert (answer.count, answer.lower_bound, answer.proven) == (1, 1, True)


def test_the_heavier_of_two_stays() -> None:
    assert fewest_vertices([[1], [0]], weights={0: 3.0}).vertices == (1,)


def test_of_a_complete_graph_all_but_the_heaviest_go() -> None:
    n = 8
    answer = fewest_vertices([[v for v in range(n) if v != u] for u in range(n)], {v: 1.0 + v for v in range(n)})
    assert answer.vertices == tuple(range(n - 1))


def test_vertices_may_have_any_numbers() -> None:
    assert fewest_vertices({7: [30], 30: [7, 99]}).count == 1


def test_a_forbidden_ring_is_shown() -> None:
    answer = fewest_vertices([[1], [2], [0], [0]], forbidden={0, 1, 2})
    assert answer.vertices is None and answer.proven
    assert sorted(answer.cycle) == [0, 1, 2]


def test_weights_are_above_zero() -> None:
    with pytest.raises(ValueError, match="above 0"):
        fewest_vertices([[1], [0]], {0: 0.0})


def test_without_work_the_answer_is_valid_and_the_bound_below_it() -> None:
    successors = large(3, 50, 5.0)
    hasty = fewest_vertices(successors, limit=Limit(solves=0, exchanges=0))
    exact = fewest_vertices(successors)
    assert exact.proven
    assert hasty.lower_bound <= exact.weight <= hasty.weight
    assert not hasty.proven and hasty.vertices is not None
    rest = set(range(50)) - set(hasty.vertices)
    assert acyclic(rest, [(u, v) for u in rest for v in successors[u] if v in rest])


def test_the_same_problem_has_the_same_answer() -> None:
    successors = large(5, 50, 4.0)
    assert fewest_vertices(successors) == fewest_vertices(successors)
