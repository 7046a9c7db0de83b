"""What is tried next: on a line of history no decision tree takes less time on average; every search ends right."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import pytest
from giving import Git
from hypothesis import example, given, settings
from hypothesis import strategies as st

from pico.history.bisect.choice import NextCommit, Suspects, choices, halfway

SECONDS = st.floats(0, 100, allow_nan=False)


@dataclass(frozen=True)
class Bench:
    """Commits with what each trial costs: from where the bench stands, and from one to another."""

    suspects: Suspects
    first: list[float]
    ways: list[list[float]]
    measure: float

    def cost(self, at: int | None, goal: int) -> float:
        return (self.first[goal] if at is None else self.ways[at][goal] if at != goal else 0.0) + self.measure

    def ranked(self) -> list[int]:
        between: Callable[[int, int], float] = lambda a, b: self.ways[a][b]  # noqa: E731
        return [c.index for c in choices(self.suspects, self.first.__getitem__, between, self.measure)]


@st.composite
def benches(draw: st.DrawFn, most: int, linear: bool) -> Bench:
    count = draw(st.integers(2, most))
    if linear:
        parents: Sequence[Sequence[int]] = [(n - 1,) if n else () for n in range(count)]
    else:
        parents = [sorted(draw(st.sets(st.integers(0, n - 1), max_size=2))) if n else [] for n in range(count - 1)]
        ends = set(range(count - 1)) - {p for own in parents for p in own}
        parents = [*parents, sorted(ends)]
    weight = draw(st.lists(st.sampled_from((1.0, 1.0, 0.1, 0.0)), min_size=count, max_size=count))
    testable = {n for n in draw(st.sets(st.integers(0, count - 2))) if weight[n]}
    row = st.lists(SECONDS, min_size=count, max_size=count)
    first, *ways = draw(st.lists(row, min_size=count + 1, max_size=count + 1))
    for through in range(count):  # no detour is shorter, or a trial that tells nothing could be worth its time
        for n in range(count):
            first[n] = min(first[n], first[through] + ways[through][n])
            for m in range(count):
                ways[m][n] = min(ways[m][n], ways[m][through] + ways[through][n])
    return Bench(Suspects(parents, weight, frozenset(testable)), first, ways, draw(st.sampled_from((0.0, 5.0, 60.0))))


def least(bench: Bench) -> float:
    """Return the least expected time over all decision trees: any suspect may be tried after any other."""
    weight, ancestors = bench.suspects.weight, bench.suspects.ancestors()

    @cache
    def expected(left: frozenset[int], at: int | None) -> float:
        total = sum(weight[c] for c in left)
        if sum(weight[c] > 0 for c in left) < 2:
            return 0.0
        found = []
        for trial in bench.suspects.testable & left:
            bad = frozenset(c for c in left if ancestors[trial] >> c & 1)
            share = sum(weight[c] for c in bad) / total
            if share > 0 and any(weight[c] for c in left - bad):  # else its result is certain
                rest = share * expected(bad, trial) + (1 - share) * expected(left - bad, trial)
                found.append(bench.cost(at, trial) + rest)
        return min(found, default=0.0)

    return expected(frozenset(range(len(weight))), None)


@settings(deadline=None, max_examples=60)
@given(benches(7, linear=True))
def test_on_a_line_of_history_no_order_of_trials_takes_less_time(bench: Bench) -> None:
    ranked = choices(bench.suspects, bench.first.__getitem__, lambda a, b: bench.ways[a][b], bench.measure)
    weight = bench.suspects.weight
    telling = {n for n in bench.suspects.testable if not any(weight) or (any(weight[: n + 1]) and any(weight[n + 1 :]))}
    assert [c.index for c in ranked] == bench.ranked() and {c.index for c in ranked} == telling
    if sum(w > 0 for w in bench.suspects.weight) > 1:
        assert (ranked[0].score() if ranked else 0.0) == pytest.approx(least(bench))


def narrowed(bench: Bench, left: list[int], at: int | None) -> tuple[list[NextCommit], list[int]]:
    """Return the choices among those that are left, from where the bench stands."""
    number = {c: n for n, c in enumerate(left)}
    parents = [[number[p] for p in bench.suspects.parents[c] if p in number] for c in left]
    testable = frozenset(number[c] for c in left[:-1] if c in bench.suspects.testable)
    suspects = Suspects(parents, [bench.suspects.weight[c] for c in left], testable)
    costs = [bench.cost(at, c) - bench.measure for c in left]
    return choices(suspects, costs.__getitem__, lambda a, b: bench.ways[left[a]][left[b]], bench.measure), left


def taken(bench: Bench, first_bad: int) -> float:
    """Return how long the search takes that always follows the best choice."""
    ancestors, weight = bench.suspects.ancestors(), bench.suspects.weight
    left, at, total = list(range(len(weight))), None, 0.0
    while sum(weight[c] > 0 for c in left) > 1:
        ranked, left = narrowed(bench, left, at)
        if not ranked:
            break
        trial = left[ranked[0].index]
        total, at = total + bench.cost(at, trial), trial
        bad = bool(ancestors[trial] >> first_bad & 1)
        left = [c for c in left if bool(ancestors[trial] >> c & 1) == bad]
    return total


ROUND_ABOUT = Suspects([[], [], [], [], [0, 1], [0, 2], [3, 4, 5]], [1.0] * 6 + [0.0], frozenset({3, 4, 5}))
"""Commit 5 is bad for sure once 3 and 4 are not, for the last changed nothing: it is no trial then."""


@settings(deadline=None, max_examples=30)
@given(benches(7, linear=False))
@example(Bench(ROUND_ABOUT, [0.0] * 7, [[0.0] * 7] * 7, 5.0))
def test_where_branches_meet_the_search_takes_no_longer_than_promised(bench: Bench) -> None:
    weight, ranked = bench.suspects.weight, narrowed(bench, list(range(len(bench.suspects.weight))), None)[0]
    if not ranked or sum(w > 0 for w in weight) < 2:
        return
    time = sum(w * taken(bench, c) for c, w in enumerate(weight)) / sum(weight)
    assert least(bench) - 1e-6 <= time <= ranked[0].score() + 1e-6


@settings(deadline=None, max_examples=30)
@given(benches(9, linear=False), st.data())
def test_whatever_the_costs_the_search_comes_to_the_first_bad_commit(bench: Bench, data: st.DataObject) -> None:
    whole = bench.suspects
    count, ancestors = len(whole.parents), whole.ancestors()
    first_bad = data.draw(st.integers(0, count - 1))
    every = replace(bench, suspects=Suspects(whole.parents, [1.0] * count, frozenset(range(count - 1))))
    left, at = list(range(count)), None
    while len(left) > 1:
        at = left[narrowed(every, left, at)[0][0].index]
        bad = bool(ancestors[at] >> first_bad & 1)
        shorter = [c for c in left if bool(ancestors[at] >> c & 1) == bad]
        assert len(shorter) < len(left)
        left = shorter
    assert left == [first_bad]


def test_a_measurement_that_takes_long_leads_to_halving_and_a_short_one_to_short_ways() -> None:
    suspects = Suspects([(n - 1,) if n else () for n in range(33)], [1.0] * 33, frozenset(range(32)))

    def tried(measure: float) -> int:
        return choices(suspects, lambda n: 10.0 * n, lambda a, b: 10.0 * abs(a - b), measure)[0].index

    assert tried(1e6) in (15, 16)
    assert tried(1.0) < 12


def test_neighbors_of_what_could_not_be_told_are_left_for_later() -> None:
    line = [(n - 1,) if n else () for n in range(9)]
    skipped = Suspects(line, [1.0] * 9, frozenset(range(8)) - {4}, frozenset({4}))
    ranked = choices(skipped, lambda _: 10.0, lambda a, b: 10.0, 5.0)
    assert abs(ranked[0].index - 4) > 1


@pytest.mark.parametrize("seed", range(3))
def test_the_middle_is_that_of_git(git: Git, seed: int) -> None:
    import random

    rng = random.Random(seed)
    git("init", "-q")
    tree = git("hash-object", "-w", "-t", "tree", "/dev/null").strip()
    names: list[str] = []
    for n in range(16):
        parents = rng.sample(names[-4:], min(len(names), rng.choice((1, 1, 2))))
        names.append(git("commit-tree", tree, "-m", str(n), *(w for p in parents for w in ("-p", p))).strip())
    lines = git("rev-list", "--topo-order", "--reverse", "--parents", names[-1], f"^{names[0]}").splitlines()
    order = [line.split()[0] for line in lines]
    parents_of = [[order.index(p) for p in line.split()[1:] if p in order] for line in lines]
    suspects = Suspects(parents_of, [1.0] * len(order), frozenset(range(len(order) - 1)))
    middle, gits = halfway(suspects), order.index(git("rev-list", "--bisect", names[-1], f"^{names[0]}").strip())
    assert middle is not None
    even = [min(bits.bit_count(), len(order) - bits.bit_count()) for bits in suspects.ancestors()]
    assert even[middle] == even[gits]
