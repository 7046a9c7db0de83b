"""Fewest stagings with options: pick and place, arcs that hold for some options only."""

from __future__ import annotations

import random
import subprocess
import sys

import pytest
from feedback_cases import all_choices, closes, holding, least_staging, possible, random_problem, weight_of

from pico.staging.feedback import (
    Arc,
    Component,
    Limit,
    Option,
    StagingAnswer,
    StagingProblem,
    arrives,
    lazy,
    leaves,
    solve,
)


def check(seed: int) -> bool:
    """Check a random problem; returns whether it has an answer."""
    problem = random_problem(random.Random(seed))
    answer, best = solve(problem), least_staging(problem)
    assert answer.proven
    if best is None:
        check_certificate(problem, answer)
        return False
    assert answer.options is not None and not answer.cycles
    assert answer.weight == pytest.approx(best) == pytest.approx(answer.lower_bound)
    assert weight_of(problem, answer.options) == pytest.approx(best)
    assert answer.staged == tuple(i for i, c in enumerate(answer.options) if c.staged)
    assert possible(problem, answer.options)
    check_order(problem, answer)
    return True


def check_order(problem: StagingProblem, answer: StagingAnswer) -> None:
    assert answer.options is not None
    place = {event: n for n, event in enumerate(answer.order)}
    assert len(place) == len(answer.order) == 2 * len(problem.components)
    for i, choice in enumerate(answer.options):
        gap = place[arrives(i)] - place[leaves(i)]
        assert gap >= 1 if choice.staged else gap == 1
    assert all(place[a.before] < place[a.after] for a in holding(problem, answer.options))


def check_certificate(problem: StagingProblem, answer: StagingAnswer) -> None:
    """Every choice closes one of the cycles, and each of them is needed for that."""
    assert answer.options is None
    closed = [tuple(closes(problem, m, cycle) for cycle in answer.cycles) for m in all_choices(problem)]
    if not closed:
        assert any(link[4] == "no way" for link in answer.cycle)
        return
    assert all(any(c) for c in closed)
    for n in range(len(answer.cycles)):
        assert any(c[n] and sum(c) == 1 for c in closed)


@pytest.mark.parametrize("first", range(0, 80, 20))
def test_random_problems_agree_with_trying_every_choice(first: int) -> None:
    solved = [check(seed) for seed in range(first, first + 20)]
    assert any(solved) and not all(solved)


def test_with_cycles_that_relaxations_find_first_they_do_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    """As large ones are solved."""
    monkeypatch.setattr(lazy, "MANY", 0)
    solved = [check(seed) for seed in range(20, 50)]
    assert any(solved) and not all(solved)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(80, 480, 40))
def test_more_random_problems_agree_with_trying_every_choice(first: int) -> None:
    for seed in range(first, first + 40):
        check(seed)


def swap(*, yaws: int = 1, staged: bool = True) -> StagingProblem:
    """Two components that stand on one another's goals."""
    options = tuple(Option(k) for k in range(yaws))
    half = options if staged else ()
    parts = tuple(Component(options, half, half) for _ in range(2))
    return StagingProblem(parts, (Arc(leaves(0), arrives(1), "body"), Arc(leaves(1), arrives(0), "body")))


def test_a_swap_stages_one() -> None:
    answer = solve(swap(yaws=4))
    assert (answer.count, answer.lower_bound, answer.proven) == (1, 1, True)


def test_a_swap_without_staging_shows_the_ring() -> None:
    answer = solve(swap(staged=False))
    assert answer.options is None and answer.proven
    (cycle,) = answer.cycles
    assert sorted(link[4] for link in cycle) == ["body", "body", "same move", "same move"]


def test_another_yaw_replaces_a_staging() -> None:
    turned = (Option(0, (Arc(leaves(1), leaves(0), "finger"),)), Option(90))
    first = Component(turned, turned, (Option(0),))
    second = Component((Option(0, (Arc(leaves(0), arrives(1), "body"),)),), (Option(0),), (Option(0),))
    answer = solve(StagingProblem((first, second)))
    assert answer.count == 0 and answer.options is not None and answer.options[0].direct == 1


def test_what_has_no_direct_option_is_staged() -> None:
    answer = solve(StagingProblem((Component((), (Option(0),), (Option(90),), weight=2.5),)))
    assert (answer.staged, answer.weight, answer.lower_bound) == ((0,), 2.5, 2.5)


def test_what_has_no_option_at_all_is_named() -> None:
    answer = solve(StagingProblem((Component((Option(0),)), Component(()))))
    assert answer.proven and answer.cycle == ((1, "arrives", 1, "leaves", "no way"),)


def test_an_arc_may_count_at_one_goal_only() -> None:
    goals = (Option("a", goal=0), Option("b", goal=1))
    blocked = Option(0, (Arc(arrives(1), arrives(0), "finger", ((0, 0),)), Arc(arrives(0), leaves(1), "finger")))
    answer = solve(StagingProblem((Component(goals), Component((blocked,)))))
    assert answer.count == 0 and answer.options is not None and answer.options[0].direct == 1


def test_nothing_to_move_is_solved() -> None:
    assert solve(StagingProblem(())) == StagingAnswer((), (), (), 0.0, 0.0, True)


def test_an_arc_to_nobody_is_refused() -> None:
    with pytest.raises(ValueError, match="not among the 1"):
        solve(StagingProblem((Component((Option(0),)),), (Arc(leaves(0), arrives(3)),)))


def test_what_needs_no_program_loads_no_solver() -> None:
    code = (
        "import sys; from pico.staging.feedback import *;"
        "solve(StagingProblem((Component((Option(0),)),))); print(*sorted({'highspy', 'numpy'} & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "\n"


def crowd(seed: int, n: int) -> StagingProblem:
    """Components in a row with three options each, of which each has an arc to some component nearby."""
    rng = random.Random(seed)

    def arcs(i: int, mine: bool) -> tuple[Arc, ...]:
        j = max(0, min(n - 1, i + rng.choice((-3, -2, -1, 1, 2, 3))))
        return (Arc(leaves(j), leaves(i) if mine else arrives(i), "finger"),) if j != i else ()

    parts = []
    for i in range(n):
        pick = tuple(Option(k, arcs(i, True)) for k in range(3))
        place = tuple(Option(k, arcs(i, False)) for k in range(3))
        direct = tuple(Option(k, a.arcs + b.arcs) for k, (a, b) in enumerate(zip(pick, place, strict=True)))
        parts.append(Component(direct, pick, place))
    bodies = tuple(Arc(leaves(i), arrives(i + d), "body") for i in range(n) for d in (-1, 1) if 0 <= i + d < n)
    return StagingProblem(tuple(parts), bodies)


def test_without_work_nothing_is_claimed_that_is_not_so() -> None:
    problem = crowd(1, 12)
    hasty, exact = solve(problem, Limit(solves=0)), solve(problem)
    assert exact.proven and exact.lower_bound == exact.weight
    assert hasty.lower_bound <= exact.weight
    if hasty.options is not None:
        assert possible(problem, hasty.options) and hasty.weight >= exact.weight


def test_the_same_problem_has_the_same_answer() -> None:
    problem = crowd(2, 12)
    assert solve(problem) == solve(problem)
