"""The parts that bounds are made of hold for every order, not only for those that were found."""

from __future__ import annotations

import random
from itertools import pairwise, permutations

import numpy as np
import pytest
from sequencing_cases import cheapest, instance, keeps

from pico.staging.sequencing import program
from pico.staging.sequencing.assignment import assign, duals
from pico.staging.sequencing.cuts import cut_bound, violated
from pico.staging.sequencing.exchange import exchangeable
from pico.staging.sequencing.flow import Network
from pico.staging.sequencing.nearest import nearest_order
from pico.staging.sequencing.problem import Effort
from pico.staging.sequencing.program import CutProgram
from pico.staging.sequencing.stretches import rearranged, stretch


def test_potentials_are_below_all_costs_and_add_up_to_the_cheapest_assignment() -> None:
    for seed in range(20):
        costs = np.random.default_rng(seed).integers(-5, 30, (6, 6)).astype(float)
        u, v = duals(costs)
        assert (u[:, None] + v[None, :] <= costs + 1e-9).all()
        best = min(sum(costs[i, j] for i, j in enumerate(p)) for p in permutations(range(6)))
        assert u.sum() + v.sum() == pytest.approx(best)


def test_what_may_come_right_after_is_what_does_in_some_order() -> None:
    for seed in range(10):
        case = instance(6, 0.25, seed)
        legal = [(6, *p, 6) for p in permutations(range(6)) if keeps(p, case.before)]
        met = {arc for line in legal for arc in pairwise(line)}
        assert met == {(i, j) for i in range(7) for j in range(7) if case.tour.successors(i) >> j & 1}


def test_an_order_with_an_arc_costs_at_least_the_bound_and_the_excess_of_the_arc() -> None:
    for seed in range(10):
        case = instance(6, 0.2, seed)
        floor = assign(case.tour)
        for order in permutations(range(6)):
            if keeps(order, case.before):
                arcs = zip((6, *order), (*order, 6), strict=True)
                excess = sum(floor.excess[arc] for arc in arcs)
                assert case.tour.cost(order) == pytest.approx(floor.bound + excess)


def test_every_legal_order_fulfills_every_cut() -> None:
    met = 0
    for seed in range(40):
        case = instance(6, 0.25, seed)
        rnd = random.Random(seed)
        pairs = [(i, j) for j in range(6) for i in range(6) if case.tour.before[j] >> i & 1]
        used = [
            (i, j, rnd.choice([0.25, 0.5, 0.75])) for i in range(7) for j in range(7)
            if case.tour.successors(i) >> j & 1 and rnd.random() < 0.35
        ]  # fmt: skip
        cuts = violated(case.tour, pairs, used)
        met += len(cuts)
        for order in permutations(range(6)):
            if keeps(order, case.before):
                arcs = list(zip((6, *order), (*order, 6), strict=True))
                assert all(any(out >> i & 1 and into >> j & 1 for i, j in arcs) for out, into in cuts)
    assert met > 100


def test_cuts_raise_the_assignment_bound_but_never_above_the_best_order() -> None:
    raised = 0
    for seed in range(40):
        case = instance(7, 0.15, seed)
        floor = assign(case.tour)
        bound = cut_bound(case.tour, nearest_order(case.tour), floor, Effort(rounds=10))
        assert floor.bound <= bound <= cheapest(case) + 1e-6
        raised += bound > floor.bound + 0.5
    assert raised > 10


@pytest.mark.parametrize("pivots", [1, 3, 8, 20])
def test_a_bound_that_is_stopped_halfway_is_one_all_the_same(pivots: int) -> None:
    less = 0
    for seed in range(20):
        case = instance(7, 0.15, seed)
        floor, order = assign(case.tour), nearest_order(case.tour)
        bound = cut_bound(case.tour, order, floor, Effort(rounds=10, pivots=pivots))
        assert floor.bound <= bound <= cheapest(case) + 1e-6
        less += bound < cut_bound(case.tour, order, floor, Effort(rounds=10)) - 0.1
    assert less > 10 or pivots > 8, "nothing was stopped"


def test_linear_programs_take_no_more_steps_than_they_may() -> None:
    case = instance(40, 0.05, 1)
    made = CutProgram(case.tour, nearest_order(case.tour), assign(case.tour).excess, 50)
    assert made.bound() > -float("inf")
    assert made.pivots == 0
    assert made.bound() == -float("inf"), "nothing is left for it"


def test_few_arcs_bound_all_orders_as_well_as_all_arcs(monkeypatch: pytest.MonkeyPatch) -> None:
    joined = 0
    for seed in range(6):
        case = instance(30, 0.1, seed)
        floor, order = assign(case.tour), nearest_order(case.tour)
        monkeypatch.setattr(program, "GOOD", 31)
        everything = CutProgram(case.tour, order, floor.excess, 100_000)
        cuts = list[tuple[int, int]]()
        for _ in range(3):
            every = everything.bound()
            cuts += (new := violated(case.tour, [], everything.used(1e-7)))
            everything.add(new)
        every = everything.bound()
        monkeypatch.setattr(program, "GOOD", 3)
        monkeypatch.setattr(program, "PRICINGS", 50)
        few = CutProgram(case.tour, order, floor.excess, 100_000)
        at_first = len(few.used(-1.0))
        few.add(cuts)
        assert few.bound() == pytest.approx(every, abs=1e-4)
        joined += len(few.used(-1.0)) - at_first
        assert len(few.used(-1.0)) < len(everything.used(-1.0)) / 2
    assert joined > 0, "no arc was ever missing"


def test_a_cut_is_found_exactly_where_too_little_can_flow() -> None:
    network = Network(5, [(0, 1, 0.5), (1, 4, 1.0), (0, 2, 0.5), (2, 3, 0.25), (3, 4, 1.0), (2, 1, 0.25)])
    assert network.cut(0, 4, 0, 1.0) is None
    assert network.cut(0, 4, 1 << 3, 1.0) == 0b00101
    assert network.cut(0, 4, 1 << 1 | 1 << 3, 0.1) == 0b00101


def test_stretches_change_places_only_where_nothing_is_ordered_between_them() -> None:
    after = (0b1000, 0, 0, 0)
    assert exchangeable([0], [1, 2], after)
    assert not exchangeable([0], [1, 3], after)
    assert not exchangeable([0, 1, 2], [3], after)
    assert exchangeable([1, 2], [3], after)


def test_no_stretch_of_a_rearranged_order_could_be_cheaper_and_precedence_is_kept() -> None:
    for seed in range(4):
        case = instance(40, 0.3, seed)
        order = nearest_order(case.tour)
        better = rearranged(case.tour, order, 4)
        assert keeps(better, case.before)
        assert case.tour.cost(better) < case.tour.cost(order)
        line = [40, *better, 40]
        for first in range(1, 36, 7):
            inner = stretch(case.tour, line, first, first + 6)
            legal = [p for p in permutations(range(6)) if all(not inner.after[b] >> a & 1 for a, b in pairs_of(p))]
            assert inner.cost(tuple(range(6))) == min(inner.cost(p) for p in legal)


def pairs_of(order: tuple[int, ...]) -> list[tuple[int, int]]:
    """Return all pairs of an order, the earlier first."""
    return [(a, b) for n, a in enumerate(order) for b in order[n + 1 :]]


def test_the_nearest_neighbor_waits_for_what_must_come_first() -> None:
    case = instance(12, 0.3, 5)
    assert keeps(nearest_order(case.tour), case.before)
